"""A copy of the checkout that tests run the workflow in, apart from the user's own results."""

import csv
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import yaml

from neural_shadows.running.kernel_cache import kernel_cache

ROOT = Path(__file__).parents[1]
SMOKE = Path("config/smoke.yaml")

# Of all tests; the user's own runs have others.
KERNELS = kernel_cache(ROOT / ".pytest_cache")

# Where somebody keeps a password, which nothing that a run writes may hold. LPIPS's trunk can be
# downloaded nowhere there, so that the tables are the same everywhere.
SECRET = "password-of-the-proxy"
_PROXY = f"http://reader:{SECRET}@127.0.0.1:9"
OFFLINE = {"http_proxy": _PROXY, "https_proxy": _PROXY, "no_proxy": ""}


def source_files() -> list[Path]:
    """Files of the checkout that git tracks or would, relative to `ROOT`."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.check_output(command, cwd=ROOT, text=True)
    paths = (Path(name) for name in listed.split("\0"))
    return [path for path in paths if (ROOT / path).is_file()]


def write_overlay(path: Path, **sections: Any) -> Path:
    path.write_text(yaml.safe_dump(sections), encoding="utf-8")
    return path


def _kernel_folders(checkout: Path, copy: Path) -> dict[str, str]:
    """Numba's names of a checkout's folders of kernels, and of the same in a copy."""
    # When Numba is imported, it reads from the environment where kernels are.
    from numba.core.caching import UserProvidedCacheLocator

    name = UserProvidedCacheLocator.get_suitable_cache_subpath
    modules = (path for path in source_files() if path.suffix == ".py" and "workflow" in path.parts)
    return {name(checkout / module): name(copy / module) for module in modules}


@dataclass(frozen=True)
class Checkout:
    """A copy of the checkout, and Snakemake in it at the smoke scale."""

    folder: Path
    cores: int = 2

    @classmethod
    def fresh(cls, folder: Path) -> "Checkout":
        """A copy of what git tracks or would.

        There are no results in it, and its kernels are those of all tests.
        """
        for path in source_files():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / path, folder / path)
        own = kernel_cache(folder / ".snakemake")
        own.mkdir(parents=True)
        for name, copied in _kernel_folders(ROOT, folder).items():
            (KERNELS / name).mkdir(parents=True, exist_ok=True)
            (own / copied).symlink_to(KERNELS / name)
        return cls(folder)

    def copy(self, folder: Path) -> "Checkout":
        """A copy with results, Snakemake's records of them, kernels and times of modification."""
        shutil.copytree(self.folder, folder, symlinks=True, dirs_exist_ok=True)
        names = _kernel_folders(self.folder, folder)
        for kernels in folder.glob(".snakemake/numba/*/*/"):
            kernels.rename(kernels.with_name(names[kernels.name]))
        return replace(self, folder=folder)

    @property
    def results(self) -> Path:
        return self.folder / "results" / "smoke"

    @property
    def reports(self) -> Path:
        return self.folder / "reports" / "smoke"

    def module(self, name: str) -> Path:
        """A module of the package."""
        return self.folder / "workflow" / "neural_shadows" / name

    def command(self, *arguments: str, overlays: Sequence[Path] = ()) -> list[str]:
        """Snakemake's command line; `overlays` are merged into the smoke configuration."""
        configs = [str(path) for path in (SMOKE, *overlays)]
        snakemake = [sys.executable, "-m", "snakemake", "--cores", str(self.cores)]
        return [*snakemake, *arguments, "--configfile", *configs]

    def environment(self) -> dict[str, str]:
        """The environment that Snakemake runs in: offline, nothing of the user's settings."""
        kept = {key: value for key, value in os.environ.items() if key != "SNAKEMAKE_PROFILE"}
        return kept | OFFLINE | {"TORCH_HOME": str(self.folder / ".torch")}

    def snakemake(
        self, *arguments: str, overlays: Sequence[Path] = ()
    ) -> subprocess.CompletedProcess[str]:
        """Run Snakemake; its `stdout` is all that it says."""
        return subprocess.run(
            self.command(*arguments, overlays=overlays),
            cwd=self.folder,
            env=self.environment(),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=3600,
        )

    def run(self, *arguments: str, overlays: Sequence[Path] = ()) -> str:
        """Run Snakemake, which must succeed, and give all that it says."""
        done = self.snakemake(*arguments, overlays=overlays)
        assert done.returncode == 0, done.stdout
        return done.stdout

    def summary(self, *targets: str, overlays: Sequence[Path] = ()) -> list[dict[str, str]]:
        """Snakemake's own account: a row per output file, with `rule`, `log-file(s)`, `plan`."""
        said = self.run(*targets, "--summary", overlays=overlays)
        header = said.index("output_file\t")
        return list(csv.DictReader(said[header:].splitlines(), delimiter="\t"))

    def pending(self, *, overlays: Sequence[Path] = ()) -> dict[str, str]:
        """What the next run would make: rule by output file."""
        rows = self.summary(overlays=overlays)
        return {row["output_file"]: row["rule"] for row in rows if row["plan"] != "no update"}
