"""All methods for soft shadows by their keys, in the order of tables."""

from neural_shadows.evaluation.soft_methods.evsm import evsm
from neural_shadows.evaluation.soft_methods.hard_map import HARD
from neural_shadows.evaluation.soft_methods.msm import msm
from neural_shadows.evaluation.soft_methods.null import null
from neural_shadows.evaluation.soft_methods.pcf import DISC_PCF, box_pcf
from neural_shadows.evaluation.soft_methods.pcss import PCSS, PCSS_POST
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.evaluation.soft_methods.vsm import vsm

METHODS: dict[str, SoftMethod] = {
    "no_shadow": null("No shadow", 1.0),
    "all_dark": null("All dark", 0.0),
    # Filters of a map's depths.
    "hard": HARD,
    **{f"pcf_{size}": box_pcf(size) for size in (3, 5, 9, 15)},
    "pcf_disc": DISC_PCF,
    "pcss": PCSS,
    "pcss_post": PCSS_POST,
    # Filtered moments.
    "vsm_3": vsm(3),
    "vsm_9": vsm(9),
    "evsm_9": evsm(9),
    "msm_3": msm(3),
    "msm_9": msm(9),
    "msm_15": msm(15, sigma=3.0),
}
