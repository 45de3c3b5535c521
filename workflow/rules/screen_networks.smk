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
    # The threads of a training keep a small machine undisturbed.
    threads: COMPUTE["threads"]
    resources:
        **usual(8000, minutes=60),
        gpu=GPUS,
    params:
        code=lambda wildcards: code(
            "evaluation/profile_screen_network",
            forms=[SETTINGS["screen_networks"][wildcards.network]["form"]],
        ),
        network=setting("screen_networks/{network}"),
        profile=SETTINGS["screen_profiles"],
        device=COMPUTE["device"],
    message:
        "Timing {wildcards.network} level by level"
    script:
        "../neural_shadows/evaluation/profile_screen_network.py"


rule train_screen:
    input:
        unpack(of(screen_networks.training_files)),
    output:
        weights=PATHS.screen_network("weights.safetensors"),
        loss_csv=PATHS.screen_network("loss.csv"),
        training_json=PATHS.screen_network("training.json"),
    log:
        PATHS.log("train_screen", "experiment"),
    benchmark:
        PATHS.benchmark("train_screen", "experiment")
    conda:
        ENVIRONMENT
    threads: COMPUTE["threads"]
    resources:
        # The same minutes for each attempt: it resumes from its last checkpoint.
        **usual(8000, minutes=600) | {"runtime": 600},
        gpu=GPUS,
    params:
        code=lambda wildcards: code(
            "training/train_screen",
            forms=screen_networks.forms(LAYOUT, [wildcards.experiment]),
        ),
        settings=of(screen_networks.training_settings),
        device=COMPUTE["device"],
        precision=COMPUTE["precision"],
    message:
        "Training {wildcards.experiment}"
    script:
        "../neural_shadows/training/train_screen.py"


rule measure_sensitivity:
    input:
        parts=of(soft_methods.validations),
        beside=of(soft_methods.tuned_arrays),
        weights=PATHS.screen_network("weights.safetensors"),
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
            forms=screen_networks.forms(LAYOUT, [wildcards.experiment]),
        ),
        seed=SETTINGS["seed"],
    message:
        "Measuring the sensitivity of {wildcards.experiment} to its features"
    script:
        "../neural_shadows/evaluation/measure_sensitivity.py"
