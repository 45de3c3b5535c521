"""What all tables, all figures and all claims have."""

from typing import Any, ClassVar, Literal

from pydantic import Field

from neural_shadows.settings.base import Model, name_in

Chapter = Literal["thesis", "extensions", "soft"]


class AnyReport(Model):
    """What tables, figures and claims have: checks and names that are followed."""

    def check(self, config: Any, key: str) -> None:
        """Check what depends on other sections.

        Args:
            config: the whole configuration (`sections.Sections`).
            key: of this entry, for messages.

        Raises:
            ValueError: something does not fit; one line that begins with the key.
        """

    def resolved(self, config: Any) -> dict[str, Any]:
        """The entry as plain data with the names that it follows, as rules look it up."""
        return self.model_dump()


class AnyTable(AnyReport):
    """What all tables have."""

    chapter: ClassVar[Chapter] = "thesis"  # of the page

    title: str = Field(min_length=1, description="heading of the table")
    published: str | None = Field(
        None, pattern=r"^4\.[1-7]$", description="the thesis's number of this table"
    )
    figures: list[name_in("figures")] = Field([], description="made and shown beside the table")
    on_request: bool = Field(False, description="made only when asked for by name")

    def methods_shown(self) -> list[str]:
        """The methods on frames that it compares, by key; none of a table of another kind."""
        return []

    def chapter_of(self) -> Chapter:
        """Where the page shows it."""
        return self.chapter


class AnyFigure(AnyReport):
    """What all figures have."""

    chapter: ClassVar[Chapter] = "extensions"  # figures with the thesis's number: its
    needs_opengl: ClassVar[bool] = False  # else it can be drawn anywhere
    folded: ClassVar[bool] = False  # on the page, unfolded by who looks for it

    title: str = Field(min_length=1, description="heading of the figure")


class Needs(Model):
    """What a run needs to decide a claim; with less it is not comparable or undecided."""

    device: Literal["cuda", "cpu"] | None = Field(None, description="that all methods are timed on")
    seeds: int | None = Field(None, ge=1, le=100, description="trainings of each network")
    budget: float | None = Field(
        None,
        gt=0,
        le=1,
        description="share of the samples of its text; with less only what learning curves license",
    )
    mesh: Literal["thesis"] | None = Field(
        None, description="`thesis`: the thesis's meshes, and no others in their place"
    )
    trunk: Literal[True] | None = Field(
        None, description="a pretrained one, so that one of its networks has a perceptual loss"
    )


class AnyClaim(AnyReport):
    """What all claims have."""

    text: Literal["thesis", "nsm", "kpnsm", "own"] = Field(
        "thesis",
        description="whose claim it is: the thesis's, Neural Shadow Mapping's (Datta et al. 2022), "
        "Kernel Predicting Neural Shadow Maps' (Hu et al. 2025), or this project's own, of methods "
        "that are not trained",
    )
    section: str = Field(
        "1",
        pattern=r"^S?[1-9](\.[0-9]+)*$",
        description="of that text, as 4.2.1; none of an own one",
    )
    statement: str = Field(min_length=1, description="one sentence, as the text draws it")
    needs: Needs = Field(Needs(), description="what a run needs to decide it")
