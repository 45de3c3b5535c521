"""Reference, shadow maps, networks and metrics on batches of viewpoints [4.1]."""


rule find_lpips:
    input:
        trunk=CONFIG.metrics.lpips.trunk or [],
        code=code("find_lpips"),
    output:
        found=f"{RESULTS}/lpips.json",
    log:
        f"{LOGS}/find_lpips.log",
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=2000,
        runtime=30,
    params:
        net=CONFIG.metrics.lpips.net,
        trunk=CONFIG.metrics.lpips.trunk,
    message:
        "Looking for LPIPS's pretrained trunk"
    script:
        "../scripts/find_lpips.py"


rule evaluate:
    input:
        mesh=lambda wildcards: LAYOUT.mesh(
            LAYOUT.evaluation_scene(wildcards.evaluation), "ply"
        ),
        weights=lambda wildcards: LAYOUT.networks(
            wildcards.evaluation, "weights.safetensors"
        ),
        lpips=f"{RESULTS}/lpips.json",
        code=code("evaluate"),
    output:
        metrics=f"{EVALUATION}/{{view_set}}.{{batch}}.csv",
        pictures=f"{EVALUATION}/{{view_set}}.{{batch}}.npz",
    log:
        f"{LOGS}/evaluate/{{evaluation}}.{{view_set}}.{{batch}}.log",
    benchmark:
        f"{BENCHMARKS}/evaluate/{{evaluation}}.{{view_set}}.{{batch}}.tsv"
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=4000,
        runtime=120,
        gpu=GPUS,
    params:
        networks=lambda wildcards: CONFIG.evaluations[wildcards.evaluation].networks,
        shadow_maps=lambda wildcards: CONFIG.evaluations[
            wildcards.evaluation
        ].shadow_maps,
        depth_bias=lambda wildcards: CONFIG.evaluations[wildcards.evaluation].depth_bias,
        first=lambda wildcards: LAYOUT.view_range(wildcards.batch)[0],
        last=lambda wildcards: LAYOUT.view_range(wildcards.batch)[1],
        up=lambda wildcards: LAYOUT.scene_param(
            LAYOUT.evaluation_scene(wildcards.evaluation), "up"
        ),
        ground=lambda wildcards: LAYOUT.scene_param(
            LAYOUT.evaluation_scene(wildcards.evaluation), "ground"
        ),
        light=lambda wildcards: LAYOUT.scene_param(
            LAYOUT.evaluation_scene(wildcards.evaluation), "light"
        ),
        width=CONFIG.rendering.width,
        height=CONFIG.rendering.height,
        reference=CONFIG.rendering.reference,
        seed=lambda wildcards: CONFIG.scene_seed(
            LAYOUT.evaluation_scene(wildcards.evaluation)
        ),
        device=CONFIG.compute.device,
        precision=CONFIG.compute.precision,
    message:
        "Rendering {wildcards.evaluation}, {wildcards.view_set} viewpoints, batch {wildcards.batch}"
    script:
        "../scripts/evaluate.py"
