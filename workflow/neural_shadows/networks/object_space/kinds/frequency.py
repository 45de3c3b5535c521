"""The thesis's fully connected network [3.3, 4.1]."""

from typing import ClassVar, Literal

from pydantic import Field

from neural_shadows.networks.settings.object_space import NetworkModel


class Settings(NetworkModel):
    """The thesis's fully connected network [3.3, 4.1]."""

    loss_of_depths: ClassVar[bool] = True
    has_shader: ClassVar[bool] = True
    encoding: Literal["frequency"] = Field("frequency", description="`frequency`, the default")
    frequencies: int = Field(ge=0, le=30, description="L of the frequency encoding; 0 is identity")
    width: int = Field(ge=8, le=4096, description="neurons per layer")
    hidden_layers: int = Field(ge=1, le=64, description="width × width layers")

    @property
    def hidden_matrices(self) -> int:
        return self.hidden_layers


def network_class() -> type:
    from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork

    return FrequencyNetwork
