"""What can lie in the place of any file, and what each format's own rules make possible."""

import gzip
import io
import json
import pickle
import tarfile
import zipfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch
from broken_meshes import ERROR, HUGE, WORKS
from readers import MEMBER, NETWORKS, READERS


class Broken(NamedTuple):
    """One input for one reader."""

    reader: str
    kind: str
    """The row of the table that it counts in."""
    name: str
    put: Callable[[Path], None]
    """Makes the whole file at this path a broken one."""
    end: str | None
    """How reading it must end; None where either is right."""


def content(data: bytes) -> Callable[[Path], None]:
    """Something else in the file's place."""
    return lambda path: path.write_bytes(data)


def edited(edit: Callable[[bytes], bytes]) -> Callable[[Path], None]:
    """The file, changed."""
    return lambda path: path.write_bytes(edit(path.read_bytes()))


# --- in the place of any file --------------------------------------------------------------


class Payload:
    """What makes the file `pickle_ran` where it is unpickled."""

    def __reduce__(self):
        return Path.touch, (Path("pickle_ran"),)


@cache
def pickles() -> dict[str, bytes]:
    """Pickles that run code, bare and in what wraps them."""
    found = {f"protocol {n}": pickle.dumps(Payload(), protocol=n) for n in (0, 2, 5)}
    objects = np.array([Payload()], dtype=object)
    for name, write in {
        "array": lambda file: np.save(file, objects, allow_pickle=True),
        "arrays": lambda file: np.savez(file, reference=objects),
        "PyTorch": lambda file: torch.save({"0.weight": Payload()}, file),
        "old PyTorch": lambda file: torch.save(
            {"0.weight": Payload()}, file, _use_new_zipfile_serialization=False
        ),
        "table": lambda file: file.write(gzip.compress(pickle.dumps(Payload()))),
    }.items():
        file = io.BytesIO()
        write(file)
        found[name] = file.getvalue()
    return found


def zipped(members: dict[str, bytes]) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    return file.getvalue()


def tarred(members: dict[str, bytes], mode: str = "w:gz") -> bytes:
    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode=mode) as tar:
        for name, data in members.items():
            info = tarfile.TarInfo(name)
            info.size = len(data)
            tar.addfile(info, io.BytesIO(data))
    return file.getvalue()


@cache
def zeros() -> bytes:
    """Of 320 MiB: more than a reader may take."""
    return bytes(5 * 2**26)


@cache
def bombs() -> dict[str, bytes]:
    """Small files that unpack to 320 MiB and to 1 GiB."""
    return {
        "gzip": gzip.compress(bytes(2**24), 9) * 64,
        "zip": zipped({"reference.npy": zeros()}),
    }


@cache
def strangers() -> dict[str, bytes]:
    """Whole files of other kinds."""
    return {
        "a picture": bytes.fromhex(
            "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c49444154"
            "08d763f8cfc0000003010100c9fe92ef0000000049454e44ae426082"
        ),
        "a page": b"<!DOCTYPE html>\n<html><body>404 Not Found</body></html>\n",
        "a program": b"\x7fELF\x02\x01\x01" + bytes(range(256)) * 20,
        "a text": "Größe: 3\n".encode() * 50,
        "an archive": zipped({"reference.npy": b"no array", "a.ply": b"ply\n"}),
        "an array": (lambda file: (np.save(file, np.arange(9)), file.getvalue())[1])(io.BytesIO()),
        "a JSON number": b"3",
        "zero bytes": bytes(5000),
    }


def in_place_of(name: str) -> Iterator[Broken]:
    """What every reader is given."""

    def broken(kind: str, what: str, put: Callable[[Path], None], end: str | None = ERROR):
        return Broken(name, kind, what, put, end)

    def folder(path: Path) -> None:
        path.unlink()
        path.mkdir()

    def missing(path: Path) -> None:
        path.unlink()

    yield broken("empty", "no bytes", content(b""))
    yield broken("empty", "a line end", content(b"\n"))
    yield broken("a directory", "empty", folder)
    # Snakemake writes no benchmark of a job that an earlier run made.
    yield broken("missing", "no file", missing, None if "benchmark" in name else ERROR)
    for what, data in pickles().items():
        yield broken("a pickle", what, content(data))
    for what, data in strangers().items():
        end = None if name == "figure" and what == "a picture" else ERROR
        yield broken("wrong extension", what, content(data), end)
    for what, data in bombs().items():
        yield broken("bomb", what, content(data))
    for what in ("../escaped", "/tmp/escaped_from_corpus"):
        yield broken("member with ..", f"zip {what}", content(zipped({what: b"bad"})))
        yield broken("member with ..", f"tar {what}", content(tarred({what: b"bad"})))
    for share in (0.1, 0.5, 0.9):
        yield broken(
            "truncated",
            f"at {share:.0%}",
            edited(lambda data, share=share: data[: int(share * len(data))]),
            None,
        )
    yield broken("truncated", "by one byte", edited(lambda data: data[:-1]), None)
    yield broken("truncated", "at its start", edited(lambda data: data[9:]), None)
    yield broken("header", "ones", edited(lambda data: b"\xff" * 40 + data[40:]), None)
    yield broken("header", "zeros", edited(lambda data: bytes(40) + data[40:]), None)
    yield broken("header", "too long", edited(lambda data: b" " * 10**6 + data), None)
    yield broken("header", "nested", content(b"[" * 200_000))
    yield broken("header", "nested keys", content(b'{"a":' * 50_000))
    yield broken("header", "one long word", content(b"a" * 10**6))


# --- formats -------------------------------------------------------------------------------


def of_format(name: str) -> Iterator[Broken]:
    """What only this reader's format makes possible."""
    makers = {
        "archive": _archives,
        "LPIPS trunk": _trunks,
        "frames": _frames,
        "metrics": _metrics,
        "loss curve": _curves,
        "config overlay": _overlays,
        "figure": _figures,
        "Markdown table": _markdown,
    }
    if name in makers:
        found = makers[name]()
    elif name.startswith("rays"):
        found = _arrays()
    elif name.startswith("network") or name == "training state":
        found = _safetensors(name)
    elif READERS[name].file.endswith(".json"):
        found = _jsons()
    elif READERS[name].file.endswith((".csv", ".tsv")):
        found = _csvs()
    else:
        return
    for kind, what, put, end in found:
        yield Broken(name, kind, what, put, end)


Found = Iterator[tuple[str, str, Callable[[Path], None], str | None]]


def _archives() -> Found:
    member = "recon/dragon.ply"
    for what, members in {
        "member": {f"../{member}": MEMBER},
        "member inside": {f"recon/../{member}": MEMBER},
        "absolute member": {f"/{member}": MEMBER},
        "beside the right one": {"../escaped": b"bad", member: MEMBER},
    }.items():
        end = WORKS if member in members else ERROR
        yield "member with ..", what, content(tarred(members)), end
    yield "values", "another mesh", content(tarred({member: MEMBER + b"!"})), ERROR
    yield "values", "no such member", content(tarred({"other.ply": MEMBER})), ERROR
    yield "wrong extension", "not compressed", content(tarred({member: MEMBER}, "w:")), ERROR
    yield "wrong extension", "bzip2", content(tarred({member: MEMBER}, "w:bz2")), ERROR
    plain = tarred({member: MEMBER}, "w:")

    def sized(text: bytes) -> bytes:
        header = plain[:124] + text + plain[136:148] + b" " * 8 + plain[156:512]
        check = b"%06o\0 " % sum(header)
        return gzip.compress(header[:148] + check + header[156:] + plain[512:])

    yield "2³¹ vertices or faces", "bytes of a member", content(sized(b"20000000000\0")), ERROR
    yield "2³¹ vertices or faces", "2⁸⁰ bytes", content(sized(b"\x80" + b"\xff" * 11)), ERROR
    yield "header", "a size of words", content(sized(b"four bytes!\0")), ERROR
    block = gzip.compress(bytes(2**24), 9)
    # A member that hides the right one behind a gigabyte, and a header of a gigabyte.
    info = tarfile.TarInfo("filling")
    info.size = 2**30
    behind = gzip.compress(info.tobuf()) + block * 64 + gzip.compress(plain)
    yield "bomb", "1 GiB before the member", content(behind), ERROR
    info = tarfile.TarInfo("long")
    info.size, info.type = 2**30, tarfile.XHDTYPE
    yield "bomb", "a header of 1 GiB", content(gzip.compress(info.tobuf()) + block * 64), ERROR
    empty = gzip.compress(tarfile.TarInfo("x").tobuf() * 2**14, 9)
    yield "bomb", "a million members", content(empty * 64), ERROR
    for what, kind in (("link", tarfile.SYMTYPE), ("device", tarfile.CHRTYPE)):
        info = tarfile.TarInfo(member)
        info.type, info.linkname = kind, "/etc/hostname"
        yield "values", f"the member is a {what}", content(gzip.compress(info.tobuf())), ERROR


def _trunks() -> Found:
    def changed(change: Callable[[dict], object], **options: bool) -> Callable[[Path], None]:
        def put(path: Path) -> None:
            state = torch.load(path, weights_only=True)
            other = change(state)
            torch.save(state if other is None else other, path, **options)

        return put

    key = "0.weight"
    for what, change in {
        "a tensor alone": lambda state: state[key],
        "a list": lambda state: list(state.values()),
        "no tensors": lambda state: {},
        "a key is missing": lambda state: {k: v for k, v in state.items() if k != key},
        "a word for a tensor": lambda state: state.update({key: "weights"}),
        "another shape": lambda state: state.update({key: state[key][:5]}),
        "sparse": lambda state: state.update({key: state[key].to_sparse()}),
        "without data": lambda state: state.update({key: state[key].to("meta")}),
        "complex": lambda state: state.update({key: state[key].to(torch.complex64)}),
        "whole numbers": lambda state: state.update({key: state[key].to(torch.int32)}),
        "NaN": lambda state: state.update({key: state[key] * np.nan}),
        "infinity": lambda state: state.update({key: state[key] / 0}),
    }.items():
        kind = "NaN or infinity" if what in ("NaN", "infinity") else "values"
        yield kind, what, changed(change), ERROR
    yield (
        "values",
        "one value for all",
        changed(lambda state: state.update({key: torch.zeros(()).expand(state[key].shape)})),
        WORKS,
    )
    yield "values", "float16", changed(lambda state: state.update({key: state[key].half()})), WORKS
    yield (
        "values",
        "old format",
        changed(lambda state: None, _use_new_zipfile_serialization=False),
        WORKS,
    )

    def deflated(path: Path) -> None:
        """The same archive with a tensor of 320 MiB, compressed."""
        with zipfile.ZipFile(path) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
        path.write_bytes(
            zipped(
                {
                    name: zeros() if "/data/" in name and name.endswith("/0") else data
                    for name, data in members.items()
                }
            )
        )

    yield "bomb", "a compressed tensor", deflated, ERROR


def _frames() -> Found:
    frame = np.full((8, 12), 128, np.uint8)

    def arrays(**named: np.ndarray) -> Callable[[Path], None]:
        def put(path: Path) -> None:
            np.savez_compressed(path, **named)

        return put

    yield "values", "no frames", arrays(), ERROR
    yield "values", "no reference", arrays(dragon=frame), ERROR
    for what, array in {
        "floats": frame / 255,
        "of three colours": np.repeat(frame[..., None], 3, axis=2),
        "a line": frame[0],
        "a number": frame[0, 0],
        "words": np.array([["a"]]),
        "of no pixel": frame[:0],
        "of another size": frame[:4],
    }.items():
        yield "values", what, arrays(reference=frame, dragon=array), ERROR
    yield (
        "bomb",
        "a frame of 320 MiB",
        content(
            zipped(
                {
                    "reference.npy": array_bytes(np.uint8, (5 * 2**12, 2**14), zeros()),
                    "dragon.npy": b"",
                }
            )
        ),
        ERROR,
    )
    shapes = {"2³¹ pixels": (HUGE,), "2⁶² pixels": (HUGE, HUGE), "-1 pixels": (-1, 5)}
    for what, shape in shapes.items():
        data = zipped({"reference.npy": array_bytes(np.uint8, shape, b"abc")})
        yield "2³¹ vertices or faces", what, content(data), ERROR
    yield "member with ..", "a frame", arrays(**{"reference": frame, "../../escaped": frame}), None


def array_bytes(dtype: type, shape: tuple[int, ...], data: bytes) -> bytes:
    """An `.npy` file with a header that may say anything."""
    header = f"{{'descr': '{np.dtype(dtype).str}', 'fortran_order': False, 'shape': {shape}, }}"
    return npy_bytes(header.encode()) + data


def npy_bytes(header: bytes) -> bytes:
    padded = header + b" " * (-(10 + len(header) + 1) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(padded).to_bytes(2, "little") + padded


def _arrays() -> Found:
    for what, shape in {
        "2³¹ directions": (HUGE, 5, 3),
        "2⁶² directions": (HUGE, HUGE, 3),
        "2¹⁰⁰ directions": (2**100, 5, 3),
        "a negative number": (-6, 5, 3),
        "none": (0, 5, 3),
        "no dimension": (),
        "a hundred dimensions": (1,) * 100,
    }.items():
        yield (
            "2³¹ vertices or faces",
            what,
            content(array_bytes(np.float32, shape, bytes(360))),
            ERROR,
        )
    for what, header in {
        "code": b"__import__('os').system('touch pickle_ran')",
        "no shape": b"{'descr': '<f4', 'fortran_order': False}",
        "a word": b"{'descr': '<f4', 'fortran_order': False, 'shape': 'many'}",
        "objects": b"{'descr': '|O', 'fortran_order': False, 'shape': (6, 5, 3)}",
        "no type": b"{'descr': 'quad', 'fortran_order': False, 'shape': (6, 5, 3)}",
        "nested": b"(" * 60_000,
        "numbers": b"9" * 60_000,
    }.items():
        yield "header", what, content(npy_bytes(header) + bytes(360)), ERROR

    def changed(change: Callable[[np.ndarray], np.ndarray]) -> Callable[[Path], None]:
        def put(path: Path) -> None:
            array = change(np.load(path, allow_pickle=False))
            with path.open("wb") as file:
                np.save(file, array)

        return put

    for what, change in {
        "float64": lambda a: a.astype(np.float64),
        "other byte order": lambda a: a.astype(">f4"),
        "whole numbers": lambda a: np.ones(a.shape, np.int32),
        "one less": lambda a: a[:-1],
        "one more": lambda a: np.concatenate([a, a[:1]]),
        "flat": lambda a: a.ravel(),
        "two coordinates": lambda a: a[..., :1],
        "words": lambda a: a.astype("U8"),
        "structured": lambda a: np.zeros(6, [("x", "f4"), ("y", "f4")]),
    }.items():
        yield "values", what, changed(change), ERROR
    yield "values", "by columns", changed(np.asfortranarray), None


def _safetensors(name: str) -> Found:
    def with_header(change: Callable[[dict], object]) -> Callable[[Path], None]:
        def edit(data: bytes) -> bytes:
            size = int.from_bytes(data[:8], "little")
            header = json.loads(data[8 : 8 + size])
            other = change(header)
            text = json.dumps(header if other is None else other).encode()
            return len(text).to_bytes(8, "little") + text + data[8 + size :]

        return edited(edit)

    def ours(change: Callable[[dict], object]) -> Callable[[Path], None]:
        """Changes what the pipeline itself writes into the header."""

        def edit(header: dict) -> None:
            own = json.loads(header["__metadata__"]["header"])
            other = change(own)
            header["__metadata__"]["header"] = json.dumps(own if other is None else other)

        return with_header(edit)

    def tensors(header: dict) -> list[dict]:
        return [value for key, value in header.items() if key != "__metadata__"]

    for what, size in {"2³¹": HUGE, "2⁶³": 2**63, "2⁶⁴−1": 2**64 - 1, "0": 0}.items():
        put = edited(lambda data, size=size: size.to_bytes(8, "little") + data[8:])
        yield "header", f"{what} bytes of header", put, ERROR
    for what, change in {
        "no metadata": lambda h: h.pop("__metadata__") and None,
        "metadata of a list": lambda h: h.update({"__metadata__": [1]}),
        "our part is no JSON": lambda h: h["__metadata__"].update({"header": "no JSON"}),
        "our part is nested": lambda h: h["__metadata__"].update({"header": "[" * 100_000}),
        "a list": lambda h: [1],
        "a tensor of words": lambda h: tensors(h)[0].update({"dtype": "WORD"}),
        "a tensor past the end": lambda h: tensors(h)[0].update({"data_offsets": [0, 10**12]}),
        "a tensor before the start": lambda h: tensors(h)[0].update({"data_offsets": [-9, 8]}),
        "a tensor is missing": lambda h: h.pop(next(k for k in h if k != "__metadata__")) and None,
        "shape of 2³¹": lambda h: tensors(h)[0].update({"shape": [HUGE, HUGE]}),
        "negative shape": lambda h: tensors(h)[0].update({"shape": [-1]}),
    }.items():
        yield "header", what, with_header(change), ERROR
    for what, change in {
        "a list": lambda own: [],
        "null": lambda own: None if own.clear() else None,
        "a number": lambda own: 3,
    }.items():
        yield "values", f"our part is {what}", ours(change), ERROR

    if name == "training state":
        for key, values in {
            "step": ("many", None, -1, 1.5, HUGE**3, [2], float("nan")),
            "seconds": ("long", None, [1], {}),
            "curve": ("steep", None, 3, [1, 2], [[1, 2]], [["a", "b", "c"]], [{}], {"a": 1}),
        }.items():
            for value in values:
                put = ours(lambda own, key=key, value=value: own.update({key: value}))
                yield "values", f"{key}: {value}", put, ERROR
    else:
        for what, change in {
            "a width of 2³¹": {"width": HUGE},
            "a width of 100,000": {"width": 100_000},
            "2³¹ layers": {"hidden_layers": HUGE},
            "2³¹ frequencies": {"frequencies": HUGE},
            "a resolution of 2³¹": {"resolution": HUGE},
            "a resolution of 4,096": {"resolution": 4096},
            "grids of 2³¹": {"grids": [HUGE, HUGE]},
            "2²⁰ grids": {"grids": [4] * 2**20},
            "2³¹ points": {"points": HUGE},
            "2³¹ cells": {"occupancy": HUGE},
            "4,096³ cells": {"occupancy": 4096},
            "a table of 2⁴⁰": {"table_size": 2**40, "grids": [2**20, 2**20]},
            "a negative width": {"width": -8},
            "a negative resolution": {"resolution": -16},
            "a width of words": {"width": "wide"},
            "half a width": {"width": 8.5},
            "half a resolution": {"resolution": 16.5},
            "a setting more": {"bias": True},
            "code": {"encoding": "os; import os"},
            "a path": {"encoding": "../../evil"},
            "a list": {"encoding": ["frequency"]},
            "another kind": {"encoding": "ray_grid"},
            "an unknown precision": {"stored": "int3"},
            "an unknown head": {"head": "two"},
            "an unknown surface": {"surface": "cloud"},
        }.items():
            known = NETWORKS[name.removeprefix("network: ")]
            if change.keys() <= known.keys() or what == "a setting more":
                put = ours(lambda own, change=change: own["network"].update(change))
                yield "values", what, put, ERROR
    yield "NaN or infinity", "weights", _nan_weights, None
    yield "values", "shapes of another network", _other_shapes, ERROR


def _nan_weights(path: Path) -> None:
    from safetensors.torch import load, save

    data = path.read_bytes()
    size = int.from_bytes(data[:8], "little")
    metadata = json.loads(data[8 : 8 + size])["__metadata__"]
    weights = {
        name: tensor * np.nan if tensor.is_floating_point() else tensor
        for name, tensor in load(data).items()
    }
    path.write_bytes(save(weights, metadata))


def _other_shapes(path: Path) -> None:
    from safetensors.torch import load, save

    data = path.read_bytes()
    size = int.from_bytes(data[:8], "little")
    metadata = json.loads(data[8 : 8 + size])["__metadata__"]
    weights = {name: tensor.reshape(-1)[:1].clone() for name, tensor in load(data).items()}
    path.write_bytes(save(weights, metadata))


def _csvs() -> Found:
    for what, edit in {
        "no header": lambda data: data.partition(b"\n")[2],
        "a header alone": lambda data: data.partition(b"\n")[0] + b"\n",
        "a column less": lambda data: b"\n".join(
            line.rpartition(b",")[0] for line in data.splitlines()
        ),
        "words for numbers": lambda data: (
            data.replace(b"0.5", b"half").replace(b"1.5", b"x").replace(b"0.25", b"x")
        ),
        "an open quote": lambda data: data.replace(b"\n", b'\n"', 1),
        "a row of one": lambda data: data + b"1\n",
        "a row of a thousand": lambda data: data + b"1," * 1000 + b"1\n",
        "zero bytes": lambda data: data.replace(b"5", b"\0"),
        "semicolons": lambda data: data.replace(b",", b";").replace(b"\t", b";"),
        "UTF-16": lambda data: data.decode().encode("utf-16"),
        "Latin-1": lambda data: data + b"\xff\xfe,\xe4\n",
        "Windows line ends": lambda data: data.replace(b"\n", b"\r\n"),
        "100,000 columns": lambda data: b"a," * 100_000 + b"b\n" + data,
    }.items():
        end = (
            ERROR
            if what in ("no header", "UTF-16", "Latin-1", "100,000 columns", "semicolons")
            else None
        )
        yield "values", what, edited(edit), end


def _metrics() -> Found:
    yield from _csvs()
    for value in (b"nan", b"inf", b"-inf", b"1e999", b""):
        put = edited(lambda data, value=value: data.replace(b"0.5", value, 1))
        yield "NaN or infinity", value.decode() or "nothing", put, ERROR
    for view in (b"1.5", b"-", b"9" * 30, b"nan"):
        put = edited(lambda data, view=view: data.replace(b"\n1,", b"\n" + view + b",", 1))
        yield "values", f"view {view.decode()}", put, ERROR
    yield "values", "a row twice", edited(lambda data: data + data.splitlines(True)[-1]), ERROR


def _curves() -> Found:
    yield from _csvs()
    for value in (b"nan", b"inf", b"", b"loss"):
        put = edited(lambda data, value=value: data.replace(b"0.25", value, 1))
        yield "NaN or infinity", value.decode() or "nothing", put, ERROR


def _jsons() -> Found:
    def changed(change: Callable[[object], object]) -> Callable[[Path], None]:
        return edited(lambda data: json.dumps(change(json.loads(data))).encode())

    def first(value: object) -> Callable[[object], object]:
        """Put a value in the place of each of the file's, one level down."""
        return lambda content: {key: value for key in content}

    for what, change in {
        "null": lambda content: None,
        "a list": lambda content: [content],
        "a number": lambda content: 3,
        "no keys": lambda content: {},
        "all null": first(None),
        "all words": first("many"),
        "all lists": first([]),
        "all objects": first({}),
        "all NaN": first(float("nan")),
        "all infinite": first(float("inf")),
        "all 10⁴⁰⁰": first(10**400),
    }.items():
        kind = "NaN or infinity" if what in ("all NaN", "all infinite") else "values"
        # No biases at all are a file of biases.
        yield kind, what, changed(change), None if what == "no keys" else ERROR
    yield "values", "a key twice", edited(lambda data: data.replace(b"{", b'{"name": 3,', 1)), None
    yield (
        "values",
        "a number of 100,000 digits",
        content(b'{"faces": ' + b"1" * 100_000 + b"}"),
        ERROR,
    )
    yield "values", "a comment", edited(lambda data: b"// hello\n" + data), ERROR
    yield "values", "two values", edited(lambda data: data + data), ERROR
    yield "values", "UTF-16", edited(lambda data: data.decode().encode("utf-16")), ERROR


def _overlays() -> Found:
    laughs = ["a0: &a0 [ha, ha, ha, ha, ha, ha, ha, ha, ha]"]
    laughs += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 10)]
    for what, text in {
        "a list": "- 1\n- 2\n",
        "a word": "scale",
        "tabs": "scale:\n\tmine\n",
        "an open quote": "scale: 'mine\n",
        "an unknown key": "sceens: {}\n",
        "a key twice": "scale: a\nscale: b\n",
        "an anchor that is not there": "scale: *a\n",
        "a key of lists": "? [1, 2]\n: 3\n",
        "a key of keys": "? {a: 1}\n: 3\n",
        "two documents": "scale: a\n---\nscale: b\n",
        "a control character": "scale: a\x07b\n",
        "a scale of dots": "scale: ../../etc\n",
        "a scale with a line": 'scale: "a\\nb"\n',
        "a scene with dots": "scenes: {../x: {mesh: {generate: fence}}}\n",
        "a null for a section": "scenes: null\n",
        "a list for a section": "scenes: [1, 2]\n",
        "a number for a section": "trainings: 3\n",
        "a mesh that is not there": "scenes: {dragon: {mesh: {generate: null, path: none.ply}}}\n",
        "a folder for a mesh": "scenes: {dragon: {mesh: {generate: null, path: /tmp}}}\n",
    }.items():
        yield "values", what, content(text.encode()), ERROR
    for value in (".nan", ".inf", "-.inf", "1e999"):
        text = f"trainings: {{base: {{learning_rate: {value}}}}}\n"
        yield "NaN or infinity", value, content(text.encode()), ERROR
    for value in (HUGE, 10**400, -1, 0):
        text = f"rendering: {{width: {value}}}\n"
        yield (
            "2³¹ vertices or faces",
            f"a width of {value:.3g}" if value < HUGE else f"a width with {len(str(value))} digits",
            content(text.encode()),
            ERROR,
        )
    for what, tag in {
        "object": "!!python/object/apply:os.system ['touch pickle_ran']",
        "name": "!!python/name:os.system",
        "module": "!!python/module:antigravity",
        "unknown tag": "!mine 3",
        "binary": "!!binary aGVsbG8=",
    }.items():
        yield "a pickle", what, content(f"scale: {tag}\n".encode()), ERROR
    yield "bomb", "aliases of aliases", content("\n".join(laughs).encode()), ERROR


def _figures() -> Found:
    def huge(data: bytes) -> bytes:
        """The same picture, of 2³⁰ × 2³⁰ pixels by its header."""
        import zlib

        header = b"IHDR" + (2**30).to_bytes(4) * 2 + data[24:29]
        return data[:12] + header + zlib.crc32(header).to_bytes(4) + data[33:]

    yield "2³¹ vertices or faces", "pixels", edited(huge), ERROR


def _markdown() -> Found:
    for what, text in {
        "no heading": "| a |\n| - |\n| 1 |\n",
        "no table": "# A table\n\nnone\n",
        "Latin-1": b"# A table \xe4\n\n| a |\n| - |\n| 1 |\n",
    }.items():
        data = text if isinstance(text, bytes) else text.encode()
        yield "values", what, content(data), ERROR
    script = "# A <script>alert(1)</script>\n\n| a |\n| - |\n| <img src=x onerror=alert(1)> |\n"
    yield "values", "a script", content(script.encode()), None
    yield "values", "nested", content(b"# A\n\n" + b"> " * 50_000 + b"\n\n| a |\n| - |\n"), None
