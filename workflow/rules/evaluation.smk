"""Reference, shadow maps, networks and metrics on batches of viewpoints [4.1]."""


rule find_lpips:
    input:
        trunk=CONFIG.metrics.lpips.trunk or [],
        code=code("find_lpips"),
    output:
        found=f"{RESULTS}/lpips.json",
    log:
        f"{LOGS}/find_lpips.log",
    # It may download: on a cluster, nodes that compute often have no network.
    localrule: True
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(2000),
        runtime=per_attempt(30),
    params:
        net=CONFIG.metrics.lpips.net,
        trunk=CONFIG.metrics.lpips.trunk,
    message:
        "Looking for LPIPS's pretrained trunk"
    script:
        "../scripts/find_lpips.py"


rule find_depth_biases:
    input:
        mesh=lambda wildcards: LAYOUT.mesh(
            LAYOUT.evaluation_scene(wildcards.evaluation), "ply"
        ),
        weights=lambda wildcards: LAYOUT.networks(
            wildcards.evaluation, "weights.safetensors"
        ),
        code=lambda wildcards: code(
            "find_depth_biases", CONFIG.evaluations[wildcards.evaluation].networks
        ),
    output:
        found=f"{EVALUATION}/depth_biases.json",
    log:
        f"{LOGS}/find_depth_biases/{{evaluation}}.log",
    benchmark:
        f"{BENCHMARKS}/find_depth_biases/{{evaluation}}.tsv"
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(60),
        gpu=GPUS,
    params:
        networks=lambda wildcards: CONFIG.evaluations[wildcards.evaluation].networks,
        view_sets=lambda wildcards: CONFIG.evaluations[wildcards.evaluation].view_sets,
        first=LAYOUT.held_out_range()[0],
        last=LAYOUT.held_out_range()[1],
        frames=lambda wildcards: LAYOUT.scene_frames(
            LAYOUT.evaluation_scene(wildcards.evaluation), CONFIG.rendering
        ),
        reference=CONFIG.rendering.reference,
        device=CONFIG.compute.device,
        precision=CONFIG.compute.precision,
    message:
        "Finding depth biases for {wildcards.evaluation}"
    script:
        "../scripts/find_depth_biases.py"


rule evaluate:
    input:
        mesh=lambda wildcards: LAYOUT.mesh(
            LAYOUT.evaluation_scene(wildcards.evaluation), "ply"
        ),
        weights=lambda wildcards: LAYOUT.networks(
            wildcards.evaluation, "weights.safetensors"
        ),
        lpips=f"{RESULTS}/lpips.json",
        depth_biases=lambda wildcards: LAYOUT.depth_biases(wildcards.evaluation),
        code=lambda wildcards: code(
            "evaluate", CONFIG.evaluations[wildcards.evaluation].networks
        ),
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
        mem_mb=per_attempt(4000),
        runtime=per_attempt(120),
        gpu=GPUS,
    params:
        networks=lambda wildcards: CONFIG.evaluations[wildcards.evaluation].networks,
        shadow_maps=lambda wildcards: CONFIG.evaluations[
            wildcards.evaluation
        ].shadow_maps,
        depth_bias=lambda wildcards: CONFIG.evaluations[wildcards.evaluation].depth_bias,
        first=lambda wildcards: LAYOUT.view_range(wildcards.batch)[0],
        last=lambda wildcards: LAYOUT.view_range(wildcards.batch)[1],
        frames=lambda wildcards: LAYOUT.scene_frames(
            LAYOUT.evaluation_scene(wildcards.evaluation), CONFIG.rendering
        ),
        reference=CONFIG.rendering.reference,
        device=CONFIG.compute.device,
        precision=CONFIG.compute.precision,
    message:
        "Rendering {wildcards.evaluation}, {wildcards.view_set} viewpoints, batch {wildcards.batch}"
    script:
        "../scripts/evaluate.py"


rule frame_times:
    input:
        mesh=f"{SCENE}/mesh.ply",
        weights=lambda wildcards: LAYOUT.table_files(
            wildcards.table, "weights.safetensors", wildcards.scene
        ),
        code=lambda wildcards: code(
            "frame_times", LAYOUT.table_experiments(wildcards.table, wildcards.scene)
        ),
    output:
        times=f"{RESULTS}/{layout.FRAME_TIMES}",
    log:
        f"{LOGS}/frame_times/{{table}}.{{scene}}.log",
    benchmark:
        f"{BENCHMARKS}/frame_times/{{table}}.{{scene}}.tsv"
    conda:
        ENVIRONMENT
    # It computes on one: with all that a training takes, nothing disturbs it on a small machine.
    threads: CONFIG.compute.threads
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(120),
        gpu=GPUS,
    params:
        networks=lambda wildcards: LAYOUT.table_networks(
            wildcards.table, wildcards.scene
        ),
        shadow_maps=lambda wildcards: LAYOUT.timed_shadow_maps(
            wildcards.table, wildcards.scene
        ),
        view_sets=lambda wildcards: LAYOUT.timed_view_sets(
            wildcards.table, wildcards.scene
        ),
        frames=lambda wildcards: LAYOUT.scene_frames(
            wildcards.scene, CONFIG.frame_times
        ),
        repeats=CONFIG.frame_times.repeats,
        warm_up=CONFIG.frame_times.warm_up,
        device=CONFIG.compute.device,
        precision=CONFIG.compute.precision,
    message:
        "Timing frames of {wildcards.scene} for {wildcards.table}"
    script:
        "../scripts/frame_times.py"
