"""View directions → rays through silhouettes and quadtrees → ray-traced labels [3.4]."""


rule view_directions:
    input:
        code=code("view_directions"),
    output:
        directions=f"{RAYS}/directions.npy",
    log:
        f"{LOGS}/view_directions/{{scene}}.{{sampling}}.log",
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(1000),
        runtime=per_attempt(10),
    params:
        sampler=lambda wildcards: CONFIG.samplings[wildcards.sampling].sampler,
        directions=lambda wildcards: CONFIG.samplings[wildcards.sampling].directions,
        seed=lambda wildcards: CONFIG.scene_seed(wildcards.scene),
        light=lambda wildcards: LAYOUT.sampling_light(
            wildcards.scene, wildcards.sampling
        ),
        up=lambda wildcards: LAYOUT.scene_param(wildcards.scene, "up"),
    message:
        "Drawing view directions of {wildcards.scene} ({wildcards.sampling})"
    script:
        "../scripts/view_directions.py"


rule sample_rays:
    input:
        mesh=f"{SCENE}/mesh.ply",
        directions=f"{RAYS}/directions.npy",
        code=code("sample_rays"),
    output:
        origins=f"{RAYS}/origins.{{shard}}.npy",
    log:
        f"{LOGS}/sample_rays/{{scene}}.{{sampling}}.{{shard}}.log",
    benchmark:
        f"{BENCHMARKS}/sample_rays/{{scene}}.{{sampling}}.{{shard}}.tsv"
    conda:
        ENVIRONMENT
    threads: CONFIG.compute.threads
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(10),
    params:
        sampler=lambda wildcards: CONFIG.samplings[wildcards.sampling].sampler,
        points_per_direction=lambda wildcards: CONFIG.samplings[
            wildcards.sampling
        ].points_per_direction,
        silhouette_resolution=lambda wildcards: CONFIG.samplings[
            wildcards.sampling
        ].silhouette_resolution,
        min_quad=lambda wildcards: CONFIG.samplings[wildcards.sampling].min_quad,
        seed=lambda wildcards: CONFIG.scene_seed(wildcards.scene),
        first=lambda wildcards: LAYOUT.shard_range(
            wildcards.sampling, wildcards.shard
        )[0],
        last=lambda wildcards: LAYOUT.shard_range(wildcards.sampling, wildcards.shard)[
            1
        ],
    message:
        "Sampling rays of {wildcards.scene} ({wildcards.sampling}), shard {wildcards.shard}"
    script:
        "../scripts/sample_rays.py"


rule label_rays:
    input:
        mesh=f"{SCENE}/mesh.ply",
        directions=f"{RAYS}/directions.npy",
        origins=f"{RAYS}/origins.{{shard}}.npy",
        code=code("label_rays"),
    output:
        bounds=f"{RAYS}/bounds.{{shard}}.npy",
    log:
        f"{LOGS}/label_rays/{{scene}}.{{sampling}}.{{shard}}.log",
    benchmark:
        f"{BENCHMARKS}/label_rays/{{scene}}.{{sampling}}.{{shard}}.tsv"
    conda:
        ENVIRONMENT
    threads: CONFIG.compute.threads
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(10),
    params:
        seed=lambda wildcards: CONFIG.scene_seed(wildcards.scene),
        first=lambda wildcards: LAYOUT.shard_range(
            wildcards.sampling, wildcards.shard
        )[0],
        last=lambda wildcards: LAYOUT.shard_range(wildcards.sampling, wildcards.shard)[
            1
        ],
    message:
        "Tracing labels of {wildcards.scene} ({wildcards.sampling}), shard {wildcards.shard}"
    script:
        "../scripts/label_rays.py"


rule describe_rays:
    input:
        mesh=f"{SCENE}/mesh.ply",
        directions=f"{RAYS}/directions.npy",
        origins=lambda wildcards: LAYOUT.ray_shards(
            wildcards.scene, wildcards.sampling, "origins"
        ),
        bounds=lambda wildcards: LAYOUT.ray_shards(
            wildcards.scene, wildcards.sampling, "bounds"
        ),
        code=code("describe_rays"),
    output:
        description=f"{RAYS}/rays.json",
    log:
        f"{LOGS}/describe_rays/{{scene}}.{{sampling}}.log",
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(2000),
        runtime=per_attempt(30),
    params:
        sampler=lambda wildcards: CONFIG.samplings[wildcards.sampling].sampler,
        silhouette_resolution=lambda wildcards: CONFIG.samplings[
            wildcards.sampling
        ].silhouette_resolution,
        min_quad=lambda wildcards: CONFIG.samplings[wildcards.sampling].min_quad,
        seed=lambda wildcards: CONFIG.scene_seed(wildcards.scene),
    message:
        "Describing the rays of {wildcards.scene} ({wildcards.sampling})"
    script:
        "../scripts/describe_rays.py"
