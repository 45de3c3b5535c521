"""One training job for each network [4.1]; none for those with shipped weights."""

RESTORED = "|".join(trainings.restored(LAYOUT)) or "(?!)"


rule restore_weights:
    input:
        file=of(trainings.shipped_file),
    output:
        weights=PATHS.network("weights.safetensors"),
        training_json=PATHS.network("training.json"),
    log:
        PATHS.log("restore_weights", "experiment"),
    wildcard_constraints:
        experiment=RESTORED,
    # May download: compute nodes of clusters often have no network.
    localrule: True
    conda:
        ENVIRONMENT
    resources:
        **usual(2000, minutes=10),
    params:
        code=lambda wildcards: code(
            "training/restore_weights", LAYOUT.network_modules([wildcards.experiment])
        ),
        settings=of(trainings.restored_settings),
    message:
        "Taking the shipped weights of {wildcards.experiment}"
    script:
        "../neural_shadows/training/restore_weights.py"


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
    wildcard_constraints:
        experiment=rf"(?!({RESTORED})\b)[a-z][a-z0-9_]*",
    conda:
        ENVIRONMENT
    threads: COMPUTE["threads"]
    resources:
        # The same minutes for each attempt: it resumes from its last checkpoint.
        **usual(8000, minutes=600) | {"runtime": 600},
        gpu=lambda wildcards: GPUS * LAYOUT.is_trained(wildcards.experiment),
        # A training also uses cores that no job of the run has.
        run_cores=SHARED_CORES,
    params:
        code=lambda wildcards: code(
            f"training/{trainings.stage(LAYOUT, wildcards.experiment)}",
            LAYOUT.network_modules([wildcards.experiment]),
        ),
        kind=of(trainings.stage),
        settings=of(trainings.settings),
        device=COMPUTE["device"],
        precision=COMPUTE["precision"],
    message:
        "Training {wildcards.experiment}"
    script:
        "../neural_shadows/training/{params.kind}.py"
