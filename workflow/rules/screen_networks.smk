"""Screen-space networks."""


rule profile_screen_network:
    output:
        profile_json=PATHS.screen_profile(),
    log:
        PATHS.log("profile_screen_network", "network"),
    benchmark:
        PATHS.benchmark("profile_screen_network", "network")
    conda:
        ENVIRONMENT
    threads: COMPUTE["timing_cores"]
    resources:
        **usual(8000, minutes=60),
        gpu=GPUS,
    params:
        code=lambda wildcards: code(
            "evaluation/profile_screen_network",
            [form_module(LAYOUT.entry("networks", wildcards.network, "form")["form"])],
        ),
        network=setting("networks/{network}"),
        profile=SETTINGS["screen_profiles"],
        device=COMPUTE["device"],
        formats=of(tables.profiled_formats),
    message:
        "Timing {wildcards.network}"
    script:
        "../neural_shadows/evaluation/profile_screen_network.py"


rule measure_sensitivity:
    input:
        parts=of(frame_sets.validations),
        beside=of(frame_sets.tuned_arrays),
        weights=PATHS.network("weights.safetensors"),
    output:
        sensitivity_json=PATHS.screen_sensitivity(),
    log:
        PATHS.log("measure_sensitivity", "frame_set", "experiment"),
    benchmark:
        PATHS.benchmark("measure_sensitivity", "frame_set", "experiment")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=60),
    params:
        code=lambda wildcards: code(
            "evaluation/measure_sensitivity",
            LAYOUT.network_modules([wildcards.experiment]),
        ),
        seed=SETTINGS["seed"],
    message:
        "Measuring the sensitivity of {wildcards.experiment} to its features"
    script:
        "../neural_shadows/evaluation/measure_sensitivity.py"
