"""`networks` by encoding, and `screen_networks` by form."""

from neural_shadows.networks.kind_module import ENCODINGS, FORMS
from neural_shadows.settings.kinds import union

Network = union(ENCODINGS, "frequency", key="encoding")
# Screen-space networks (Datta et al. 2022, 3.5; Hu et al. 2025, 4.2.1).
ScreenNetwork = union(FORMS, key="form")
