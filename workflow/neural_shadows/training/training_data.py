"""Description of the frames behind a network."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from neural_shadows.frames.frame_set import FrameSetPart


def describe_data(train: Sequence[Path], validation: Sequence[Path]) -> dict[str, Any]:
    """`frame_set`; of both uses `frames`, `layouts`, `width`, `height`.

    Args:
        train, validation: JSON files of parts, in FRAME_SET/SCENE/; a scene with new layouts has one a
            part.
    """
    return {
        "frame_set": train[0].parents[1].name,
        "train": _count(train),
        "validation": _count(validation),
    }


def _count(paths: Sequence[Path]) -> dict[str, int]:
    parts = [FrameSetPart(path) for path in paths]
    scenes = (part.about.get("scene", part.frames_json.parent.name) for part in parts)
    return {
        "frames": sum(map(len, parts)),
        "layouts": len({json.dumps(scene, sort_keys=True) for scene in scenes}),
        "width": parts[0].about["width"],
        "height": parts[0].about["height"],
    }
