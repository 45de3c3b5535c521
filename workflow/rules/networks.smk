"""One training job for each network [4.1]."""


rule train:
    input:
        unpack(of(trainings.files)),
    output:
        weights=PATHS.network("weights.safetensors"),
        loss_csv=PATHS.network("loss.csv"),
        training_json=PATHS.network("training.json"),
    log:
        PATHS.log("train", "experiment"),
    benchmark:
        PATHS.benchmark("train", "experiment")
    conda:
        ENVIRONMENT
    threads: COMPUTE["threads"]
    resources:
        # The same minutes for each attempt: it resumes from its last checkpoint.
        **usual(8000, minutes=600) | {"runtime": 600},
        gpu=lambda wildcards: GPUS * LAYOUT.is_trained(wildcards.experiment),
    params:
        code=lambda wildcards: code(
            f"training/{trainings.stage(LAYOUT, wildcards.experiment)}",
            LAYOUT.encodings([wildcards.experiment]),
            forms=LAYOUT.forms([wildcards.experiment]),
        ),
        kind=of(trainings.stage),
        settings=of(trainings.settings),
        device=COMPUTE["device"],
        precision=COMPUTE["precision"],
    message:
        "Training {wildcards.experiment}"
    script:
        "../neural_shadows/training/{params.kind}.py"
