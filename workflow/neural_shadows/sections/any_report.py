"""Base classes of tables, figures and claims."""

from typing import Any, ClassVar, Literal

from pydantic import Field

from neural_shadows.settings.base import Model, name_in

Chapter = Literal["thesis", "extensions", "soft", "networks", "costs"]


class AnyReport(Model):
    """Common base of tables, figures and claims."""

    def check(self, config: Any, key: str) -> None:
        """Check the entry against other sections.

        Args:
            config: the whole configuration (`sections.Sections`).
            key: of this entry, for messages.

        Raises:
            ValueError: the entry contradicts another section; one line, beginning with the key.
        """

    def resolved(self, config: Any) -> dict[str, Any]:
        """Plain data for rules, with names replaced by their entries."""
        return self.model_dump()


class AnyTable(AnyReport):
    """Common base of tables."""

    own_chapter: ClassVar[Chapter] = "thesis"  # of the page

    title: str = Field(min_length=1, description="heading of the table")
    published: str | None = Field(
        None, pattern=r"^4\.[1-7]$", description="its number in the thesis"
    )
    figures: list[name_in("figures")] = Field([], description="names in `figures`, shown with it")
    on_request: bool = Field(False, description="built only if requested by name")
    chapter: Chapter | None = Field(None, description="of the page; by default its kind's")

    def methods_shown(self) -> list[str]:
        """Keys of the compared methods on frames; empty for other kinds."""
        return []

    def chapter_of(self) -> Chapter:
        """Chapter of the page."""
        return self.chapter or self.own_chapter


class AnyFigure(AnyReport):
    """Common base of figures."""

    # Of the page; None: the thesis's by its number, or else its table's.
    own_chapter: ClassVar[Chapter | None] = None
    needs_opengl: ClassVar[bool] = False  # for drawing
    folded: ClassVar[bool] = False  # collapsed on the page

    title: str = Field(min_length=1, description="heading of the figure")


class Needs(Model):
    """Requirements of a claim; unmet, it stays undecided or not comparable."""

    device: Literal["cuda", "cpu"] | None = Field(None, description="device of all timed methods")
    seeds: int | None = Field(None, ge=1, le=100, description="trainings (seeds) of each network")
    budget: float | None = Field(
        None,
        gt=0,
        le=1,
        description="least share of the publication's training samples; below it, only learning curves "
        "can decide the claim",
    )
    mesh: Literal["thesis"] | None = Field(
        None, description="`thesis`: only the thesis's own meshes count, no stand-ins"
    )
    trunk: Literal[True] | None = Field(
        None, description="`true`: a network must have been trained with a perceptual loss"
    )


class AnyClaim(AnyReport):
    """Common base of claims."""

    text: Literal["thesis", "nsm", "kpnsm", "own"] = Field(
        "thesis",
        description="source of the claim: the thesis, Neural Shadow Mapping (Datta et al. 2022), "
        "Kernel Predicting Neural Shadow Maps (Hu et al. 2025), or this project (about methods "
        "without training)",
    )
    section: str = Field(
        "1",
        pattern=r"^S?[1-9](\.[0-9]+)*$",
        description="section of the source, such as 4.2.1; without meaning for `text: own`",
    )
    statement: str = Field(min_length=1, description="the claim in one sentence")
    question: str | None = Field(
        None, min_length=1, description="that it answers among the page's findings"
    )
    figure: name_in("figures") | None = Field(
        None, description="a name in `figures`: the picture of that finding"
    )
    needs: Needs = Field(Needs(), description="requirements for deciding the claim")
