"""View directions → rays through silhouettes and quadtrees → ray-traced labels [3.4]."""


rule draw_directions:
    output:
        directions_npy=PATHS.rays("directions.npy"),
    log:
        PATHS.log("draw_directions", "scene", "sampling"),
    benchmark:
        PATHS.benchmark("draw_directions", "scene", "sampling")
    conda:
        ENVIRONMENT
    resources:
        **usual(1000, minutes=10),
    params:
        code=code("rays/draw_directions"),
        sampling=setting("samplings/{sampling}"),
        seed=setting("scenes/{scene}/seed"),
        light=of(LAYOUT.direction_light),
        up=setting("scenes/{scene}/up"),
    message:
        "Drawing view directions of {wildcards.scene} ({wildcards.sampling})"
    script:
        "../neural_shadows/rays/draw_directions.py"


rule sample_rays:
    input:
        mesh_ply=PATHS.scene("mesh.ply"),
        directions_npy=PATHS.rays("directions.npy"),
    output:
        origins_npy=PATHS.rays("origins.{shard}.npy"),
        bounds_npy=PATHS.rays("bounds.{shard}.npy"),
    log:
        PATHS.log("sample_rays", "scene", "sampling", "shard"),
    benchmark:
        PATHS.benchmark("sample_rays", "scene", "sampling", "shard")
    conda:
        ENVIRONMENT
    threads: COMPUTE["threads"]
    resources:
        **usual(4000, minutes=10),
    params:
        code=code("rays/sample_rays"),
        sampling=setting("samplings/{sampling}"),
        seed=setting("scenes/{scene}/seed"),
        settings=of(LAYOUT.shard_range),
    message:
        "Sampling and tracing rays of {wildcards.scene} ({wildcards.sampling}), shard {wildcards.shard}"
    script:
        "../neural_shadows/rays/sample_rays.py"


rule describe_rays:
    input:
        unpack(of(LAYOUT.shards)),
        mesh_ply=PATHS.scene("mesh.ply"),
        directions_npy=PATHS.rays("directions.npy"),
    output:
        rays_json=PATHS.rays("rays.json"),
    log:
        PATHS.log("describe_rays", "scene", "sampling"),
    conda:
        ENVIRONMENT
    resources:
        **usual(2000, minutes=30),
    params:
        code=code("rays/describe_rays"),
        sampling=setting("samplings/{sampling}"),
        seed=setting("scenes/{scene}/seed"),
    message:
        "Describing the rays of {wildcards.scene} ({wildcards.sampling})"
    script:
        "../neural_shadows/rays/describe_rays.py"
