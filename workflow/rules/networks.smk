"""One training job for each network [4.1], and its export for renderers."""


rule train:
    input:
        unpack(lambda wildcards: LAYOUT.training_rays(wildcards.experiment)),
        mesh=lambda wildcards: LAYOUT.training_mesh(wildcards.experiment),
        code=lambda wildcards: code("train", [wildcards.experiment]),
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
        mem_mb=per_attempt(8000),
        # Not more for each attempt: it goes on from its last saved state.
        runtime=600,
        gpu=GPUS,
    params:
        network=lambda wildcards: LAYOUT.network_settings(wildcards.experiment),
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
        loss=lambda wildcards: LAYOUT.training_param(wildcards.experiment, "loss"),
        seed=lambda wildcards: LAYOUT.experiment_seed(wildcards.experiment),
        device=CONFIG.compute.device,
        precision=CONFIG.compute.precision,
    message:
        "Training {wildcards.experiment}"
    script:
        "../scripts/train.py"


rule export_network:
    input:
        weights=f"{NETWORK}/weights.safetensors",
        mesh=lambda wildcards: LAYOUT.mesh(
            CONFIG.experiments[wildcards.experiment].scene, "json"
        ),
        depth_biases=lambda wildcards: LAYOUT.export_biases(wildcards.experiment),
        code=lambda wildcards: code("export_network", [wildcards.experiment]),
    output:
        onnx=f"{NETWORK}/network.onnx",
        conventions=f"{NETWORK}/network.json",
    log:
        f"{LOGS}/export_network/{{experiment}}.log",
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(30),
    params:
        depth_bias=lambda wildcards: LAYOUT.export_bias(wildcards.experiment),
    message:
        "Exporting {wildcards.experiment} as ONNX"
    script:
        "../scripts/export_network.py"
