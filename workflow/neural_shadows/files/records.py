"""The JSON files that jobs leave for later ones, checked for what is read of them.

Each function gives the file's whole content.

Raises:
    InputError: the file is missing; or it is not what it should be, and moved aside.
"""

from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, FiniteFloat, TypeAdapter, ValidationError

from neural_shadows.files.broken import broken
from neural_shadows.files.whole_files import read_json

_Numbers = Annotated[list[FiniteFloat], Field(min_length=1)]


def _read(path: str | Path, kind: type, what: str) -> dict[str, Any]:
    record = read_json(path)
    try:
        TypeAdapter(kind).validate_python(record, strict=True)
    except ValidationError as error:
        first = error.errors(include_input=False, include_url=False)[0]
        key = ".".join(map(str, first["loc"]))
        problem = f"{key}: {first['msg']}" if key else first["msg"]
        raise broken(path, f"no {what} ({problem})") from error
    return record
