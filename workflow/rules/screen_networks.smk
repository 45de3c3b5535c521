"""Networks that answer whole frames."""


rule profile_screen_network:
    input:
        code=code("evaluation/profile_screen_network"),
    output:
        profile_json=PATHS.screen_profile(),
    log:
        PATHS.log("profile_screen_network", "network"),
    benchmark:
        PATHS.benchmark("profile_screen_network", "network")
    conda:
        ENVIRONMENT
    # All that a training takes, so that nothing disturbs it on a small machine.
    threads: COMPUTE["threads"]
    resources:
        **usual(8000, minutes=60),
        gpu=GPUS,
    params:
        network=setting("screen_networks/{network}"),
        profile=SETTINGS["screen_profiles"],
        device=COMPUTE["device"],
    message:
        "Timing {wildcards.network} level by level"
    script:
        "../neural_shadows/evaluation/profile_screen_network.py"
