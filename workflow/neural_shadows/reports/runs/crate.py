"""RO-Crate of a run: its files and their origin in a vocabulary of archives."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rocrate.model import ContextEntity
from rocrate.rocrate import ROCrate

from neural_shadows.files.whole_files import write_text
from neural_shadows.running.provenance import describe_hardware


def write_crate(path: Path, manifest: Mapping[str, Any]) -> None:
    """Write `ro-crate-metadata.json` beside the files that it describes."""
    crate = ROCrate()
    crate.name = f"Neural shadows: a run at the scale {manifest['scale']}"
    crate.description = f"Tables, figures and claims by commit {manifest['commit']}."
    crate.license = "https://spdx.org/licenses/MIT"
    code = {"@type": "SoftwareSourceCode", "name": "Neural shadows", "version": manifest["commit"]}
    workflow = crate.add(ContextEntity(crate, "#workflow", code))
    files = [
        crate.add_file(
            dest_path=name, properties={"contentSize": file["bytes"], "sha256": file["sha256"]}
        )
        for name, file in manifest["files"].items()
    ]
    action = {"name": manifest["command"], "description": describe_hardware(manifest["machine"])}
    if time := manifest["time"]:
        action |= {"startTime": time["first_start"], "endTime": time["last_end"]}
        crate.datePublished = time["last_end"]
    crate.add_action(workflow, "#run", result=files, properties=action)
    write_text(path, json.dumps(crate.metadata.generate(), indent=1, ensure_ascii=False) + "\n")
