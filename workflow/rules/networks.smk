"""One training job for each network [4.1]."""


rule train:
    input:
        unpack(lambda wildcards: LAYOUT.training_rays(wildcards.experiment)),
        code=code("train"),
    output:
        weights=f"{NETWORK}/weights.safetensors",
        loss=f"{NETWORK}/loss.csv",
        record=f"{NETWORK}/training.json",
    log:
        f"{LOGS}/train/{{experiment}}.log",
    benchmark:
        f"{BENCHMARKS}/train/{{experiment}}.tsv"
    conda:
        ENVIRONMENT
    threads: CONFIG.compute.threads
    resources:
        mem_mb=8000,
        runtime=600,
        gpu=GPUS,
    params:
        frequencies=lambda wildcards: LAYOUT.network_param(
            wildcards.experiment, "frequencies"
        ),
        width=lambda wildcards: LAYOUT.network_param(wildcards.experiment, "width"),
        hidden_layers=lambda wildcards: LAYOUT.network_param(
            wildcards.experiment, "hidden_layers"
        ),
        steps=lambda wildcards: LAYOUT.training_param(wildcards.experiment, "steps"),
        batch_size=lambda wildcards: LAYOUT.training_param(
            wildcards.experiment, "batch_size"
        ),
        learning_rate=lambda wildcards: LAYOUT.training_param(
            wildcards.experiment, "learning_rate"
        ),
        schedule=lambda wildcards: LAYOUT.training_param(
            wildcards.experiment, "schedule"
        ),
        seed=lambda wildcards: LAYOUT.experiment_seed(wildcards.experiment),
        device=CONFIG.compute.device,
        precision=CONFIG.compute.precision,
    message:
        "Training {wildcards.experiment}"
    script:
        "../scripts/train.py"
