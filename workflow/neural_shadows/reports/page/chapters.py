"""The page's chapters: what each asks, its figures and tables."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from neural_shadows.evaluation.look import Look
from neural_shadows.reports.page.blocks import Block
from neural_shadows.reports.page.table_blocks import shown_looks
from neural_shadows.sections.any_report import Chapter as Name

# Title and subject of each, in the order of a reader's questions.
CHAPTERS: Mapping[Name, tuple[str, str]] = {
    "thesis": (
        "Hard shadows: the thesis",
        "A network for each object answers whether a ray through the object's bounding sphere meets it "
        "(Spanhoff 2026). Beside it stand shadow maps, at the thesis's views and light.",
    ),
    "extensions": (
        "Hard shadows: meshes, fields and other networks",
        "What else can stand in for the mesh at these views: a decimated mesh, a sparse grid of distances "
        "or of occupancy, fitted or trained, a network of another form.",
    ),
    "soft": (
        "Soft shadows: maps, rays and filters",
        "The visibility of a light of some size, by shadow maps with every classic filter, and by a few "
        "rays a pixel, plain and denoised.",
    ),
    "networks": (
        "Soft shadows: networks on frames",
        "Neural Shadow Mapping (Datta et al. 2022), kernel prediction (Hu et al. 2025) and a network of "
        "our own answer a whole frame from its G-buffer and a shadow map or two rays a pixel.",
    ),
    "costs": (
        "Where each method wins: bytes and time",
        "Quality over the bytes that a method stores, for hard shadows, and error over the time of a frame, "
        "for soft ones.",
    ),
}
# So many tables are shown open.
FEW = 3


@dataclass(frozen=True)
class Chapter:
    """A chapter of the page.

    Args:
        legend: looks of the methods of its tables.
        blocks: its figures, then its tables.
        opened: whether its tables are shown without a click.
    """

    name: str
    title: str
    subject: str
    legend: Sequence[Look]
    blocks: Sequence[Block]
    opened: bool


def chapters(
    tables: Sequence[Block], figures: Sequence[Block], of: Mapping[str, str]
) -> list[Chapter]:
    """Chapters with a table or a figure.

    Args:
        of: chapter of each table and figure, by name.
    """
    few = len(tables) <= FEW
    result = []
    for name, (title, subject) in CHAPTERS.items():
        own = [block for block in tables if of[block.name] == name]
        drawn = sorted(
            (block for block in figures if of[block.name] == name), key=lambda block: block.name
        )
        if own or drawn:
            result.append(Chapter(name, title, subject, shown_looks(own), [*drawn, *own], few))
    return result
