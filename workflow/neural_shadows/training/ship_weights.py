"""Weights to ship, with their model card: `python -m neural_shadows.training.ship_weights`.

Takes folders `results/networks/NAME` of trained screen-space networks, and writes
`workflow/weights/NAME.safetensors` and `NAME.md`. Without any it writes the cards of all that ships anew.
"""

import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import read_json, sha256_of, write_text
from neural_shadows.networks.weight_file import load_tensors, save_tensors
from neural_shadows.running.origin import CHECKOUT
from neural_shadows.training.model_card import model_card
from neural_shadows.training.restore_weights import check_header

LICENCE = "MIT"
SHIPPED = CHECKOUT / "workflow" / "weights"


def ship_weights(trained: Path, shipped: Path) -> None:
    """Write weights with all of training.json in their header, and a card beside.

    The training itself leaves seconds and machine out of its weights: they are the same to the byte
    however often it is resumed.

    Args:
        trained: folder with `weights.safetensors` and `training.json`. shipped: the file to write.

    Raises:
        InputError: a file is missing or damaged, or of another training, or lacks a number of the
            card.
    """
    tensors, header = load_tensors(trained / "weights.safetensors")
    record = read_json(trained / "training.json")
    if other := [key for key, value in header.items() if record.get(key) != value]:
        raise InputError(
            f"{trained}/training.json: {other[0]}: is not that of weights.safetensors beside it. Train "
            "again"
        )
    header = {**record, "licence": LICENCE}
    check_header(header, trained / "training.json", "Train it again")
    shipped.parent.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(dir=shipped.parent) as folder:
        new = Path(folder, shipped.name)
        save_tensors(new, tensors, header)
        card = model_card(new)
        new.replace(shipped)
    write_text(shipped.with_suffix(".md"), card)


def _main(folders: Sequence[str]) -> None:
    for folder in map(Path, folders):
        shipped = SHIPPED / f"{folder.name}.safetensors"
        ship_weights(folder, shipped)
        path = shipped.relative_to(CHECKOUT)
        print(f"{folder.name}: weights: {{path: {path}, sha256: {sha256_of(shipped)}}}")
    for shipped in () if folders else SHIPPED.glob("*.safetensors"):
        write_text(shipped.with_suffix(".md"), model_card(shipped))


if __name__ == "__main__":
    try:
        _main(sys.argv[1:])
    except (InputError, OSError) as error:
        sys.exit(str(error))
