"""Reference of all configuration keys, from their models, and of all methods' keys."""

import re
from collections.abc import Iterable, Iterator
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from neural_shadows.config.whole import Config
from neural_shadows.evaluation.registry import METHODS, family_look
from neural_shadows.settings.base import Model

HEAD = """# Keys of the configuration

Made from the models by `PYTHONPATH=workflow python -m neural_shadows.config --markdown > config/REFERENCE.md`.
A key without a default is needed. [README.md](README.md) has examples; editors show the same from the schema.
"""

METHODS_HEAD = """## Methods of tables

Of *frames*, in `methods` of tables of soft shadows; of *views*, in `rows` of tables of hard ones, where N is a size from 2 to
32768, and `ray_traced` is the reference, a row of tables of times alone. Any other key is that of an experiment, a network.
"""


def markdown() -> str:
    """Chapters for sections, with tables of keys for their models."""
    parts = [HEAD, "## Single values\n"]
    simple = {k: v for k, v in Config.model_fields.items() if not list(_models(v.annotation))}
    parts.append(_table(simple))
    shown: set[type[Model]] = set()
    for name, field in Config.model_fields.items():
        if name in simple:
            continue
        parts.append(f"## `{name}`\n\n{_sentence(field.description)}\n")
        models = list(_models(field.annotation))
        common = _common(models)
        if common:
            parts += ["All have:\n", _table(common)]
        parts += _chapters(models, {*common}, shown)
    parts += [METHODS_HEAD, _methods()]
    return "\n".join(parts)


def _common(models: list[type[Model]]) -> dict[str, FieldInfo]:
    """Fields shared by all of several models, with equal descriptions."""
    first, *others = (model.model_fields for model in models)
    return {
        name: field
        for name, field in first.items()
        if others and all(name in o and o[name].description == field.description for o in others)
    }


def _chapters(
    models: Iterable[type[Model]], without: set[str], shown: set[type[Model]]
) -> Iterator[str]:
    """Tables of models and of nested models, `without` some fields."""
    for model in models:
        if model in shown:
            continue
        shown.add(model)
        fields = {k: v for k, v in model.model_fields.items() if k not in without and not _tag(v)}
        yield f"### {_title(model)}\n\n{' '.join((model.__doc__ or '').split())}\n"
        if fields:
            yield _table(fields)
        for field in model.model_fields.values():
            yield from _chapters(_models(field.annotation), set(), shown)


def _tag(field: FieldInfo) -> bool:
    """Check for a key with a single value, the kind."""
    return get_origin(field.annotation) is Literal and len(get_args(field.annotation)) == 1


def _title(model: type[Model]) -> str:
    """Title of a model: the key and value that choose it, or its class."""
    for key, field in model.model_fields.items():
        if _tag(field):
            return f"`{key}: {get_args(field.annotation)[0]}`"
    return re.sub(r"(?<!^)(?=[A-Z])", " ", model.__name__).capitalize()


def _table(fields: dict[str, FieldInfo]) -> str:
    rows = ["| key | default | what |", "| --- | --- | --- |"]
    for name, field in fields.items():
        description = (field.description or "").replace("|", "\\|").replace("\n", " ")
        rows.append(f"| `{name}` | {_default(field)} | {description} |")
    return "\n".join(rows) + "\n"


def _methods() -> str:
    rows = ["| key | method | of | what |", "| --- | --- | --- | --- |"]
    for key, method in METHODS.items():
        kinds = {"frames": method.answers_frames, "views": method.answers_views}
        of = ", ".join(kind for kind, answers in kinds.items() if answers)
        name = f"{key}_N" if method.sizes else key
        label = method.label.format("N") if method.sizes else method.label
        rows.append(f"| `{name}` | {label} | {of} | {family_look(key).sentence} |")
    return "\n".join(rows) + "\n"


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return ""
    if field.default_factory is not None:
        return "see right"
    value = field.get_default()
    if value is None:
        return "none"
    if isinstance(value, Model):
        return "its own"
    return f"`{value}`".replace("|", "\\|")


def _models(annotation: Any) -> Iterator[type[Model]]:
    """Models within an annotation, in order."""
    if isinstance(annotation, type) and issubclass(annotation, Model):
        yield annotation
    else:
        for part in get_args(annotation):
            yield from _models(part)


def _sentence(text: str | None) -> str:
    return f"{text[:1].upper()}{text[1:]}." if text else ""
