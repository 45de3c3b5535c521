"""Common settings of networks of one object."""

from typing import ClassVar, Literal

from neural_shadows.settings.base import Model

Stored = Literal["float32", "float16", "int8"]
Surface = Literal["auto", "solid", "sheet"]
SURFACE = (
    "`solid`: the object has an inside; `sheet`: one open surface; `auto`: a sheet where the mesh is "
    "open and thin, else a solid"
)


class NetworkModel(Model):
    """Properties of a kind for the graph and the checks.

    `encoding` is the name of the kind's file.
    """

    trained: ClassVar[bool] = True  # else its experiments have no sampling and no training
    needs_mesh: ClassVar[bool] = False
    of_scene: ClassVar[tuple[str, ...]] = ()  # settings that default to the scene's
    loss_of_depths: ClassVar[bool] = False  # the dead-zone loss alone, as the thesis's
    holds_field: ClassVar[bool] = False  # an occupancy field, for figures of fields
    has_shader: ClassVar[bool] = False  # in workflow/report/viewer/shaders

    @property
    def needs_training(self) -> bool:
        """True for weights useless before training."""
        return self.trained

    @property
    def hidden_matrices(self) -> int:
        """Matrices between two layers of neurons, for Muon."""
        return 0
