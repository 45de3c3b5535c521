"""No input makes a reader crash, hang, take much memory, run code or leave half a file.

`pytest tests/corpus --hypothesis-profile=full` tries some twenty times as many, and meshes of two
million triangles in each format.
"""

from collections.abc import Iterable, Iterator

import pytest
from broken_files import Broken, content, in_place_of, of_format
from broken_meshes import WORKS, File, raw_files, shaped_files, sheet
from hypothesis import given, settings
from mesh_formats import WRITERS
from mutations import changed_bytes, changed_json, changed_numbers, meshes
from readers import MESHES, READERS
from sandbox import Bounds

# What a mesh of two million triangles may take.
LARGE = Bounds(cpu_s=120, mib=4000)

JSONS = [name for name, reader in READERS.items() if reader.file.endswith(".json")]
TEXTS = [
    name
    for name, reader in READERS.items()
    if reader.file.endswith((".obj", ".csv", ".tsv", ".json", ".yaml")) or "ascii" in reader.file
    if name != "LPIPS choice"  # which holds no number
]


def assert_all_end_well(trials, inputs: Iterable[Broken]) -> None:
    faults = [fault for broken in inputs if (fault := trials.fault(broken))]
    assert not faults, f"{len(faults)} inputs:\n" + "\n".join(faults)


@pytest.mark.parametrize("reader", READERS)
def test_in_the_place_of_a_file(trials, reader):
    assert_all_end_well(trials, (*in_place_of(reader), *of_format(reader)))


def inputs(files: Iterable[File]) -> Iterator[Broken]:
    for file in files:
        put = content(file.content)
        yield Broken(f"mesh {file.file}", file.kind, file.name, put, file.end)


@pytest.mark.parametrize("files", [shaped_files, raw_files], ids=lambda files: files.__name__)
def test_meshes_from_the_wild(trials, files):
    assert_all_end_well(trials, inputs(files()))


def test_millions_of_triangles(trials):
    full = settings.get_current_profile_name() == "full"
    for name in WRITERS if full else ["source.ply", "source.obj.gz"]:
        data = WRITERS[name](*sheet(2_000_000 if full else 200_000))
        kind = "two million triangles" if full else "200,000 triangles"
        (broken,) = inputs([File(kind, "a sheet", name, data, WORKS)])
        assert trials.fault(broken, LARGE) is None


def assert_ends_well(trials, reader: str, kind: str, data: bytes) -> None:
    fault = trials.fault(Broken(reader, kind, "drawn", content(data), None))
    assert fault is None, fault


@pytest.mark.parametrize("reader", READERS)
def test_changed_bytes(trials, reader):
    @given(changed_bytes(trials.whole(reader)))
    def check(data):
        assert_ends_well(trials, reader, "mutated bytes", data)

    check()


@pytest.mark.parametrize("reader", TEXTS)
def test_changed_numbers(trials, reader):
    @given(changed_numbers(trials.whole(reader)))
    def check(data):
        assert_ends_well(trials, reader, "mutated numbers", data)

    check()


@pytest.mark.parametrize("reader", JSONS)
def test_changed_values(trials, reader):
    @given(changed_json(trials.whole(reader)))
    def check(data):
        assert_ends_well(trials, reader, "mutated values", data)

    check()


@pytest.mark.parametrize("reader", [name for name in MESHES if not name.endswith(".gz")])
def test_drawn_meshes(trials, reader):
    write = WRITERS[READERS[reader].file]

    @given(meshes())
    def check(mesh):
        assert_ends_well(trials, reader, "drawn meshes", write(*mesh))

    check()
