"""Mesh source → clean mesh in normalised space, with its bounding sphere and a preview."""


rule generate_mesh:
    input:
        code=code("generate_mesh"),
    output:
        mesh=f"{SCENE}/generated.ply",
    log:
        f"{LOGS}/generate_mesh/{{scene}}.log",
    benchmark:
        f"{BENCHMARKS}/generate_mesh/{{scene}}.tsv"
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(10),
    params:
        mesh=lambda wildcards: LAYOUT.scene_param(wildcards.scene, "mesh"),
    message:
        "Making the mesh of scene {wildcards.scene}"
    script:
        "../scripts/generate_mesh.py"


rule download_mesh:
    input:
        code=code("download_mesh"),
    output:
        mesh=f"{SCENE}/downloaded.ply",
    log:
        f"{LOGS}/download_mesh/{{scene}}.log",
    # On a cluster, nodes that compute often have no network.
    localrule: True
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(1000),
        runtime=per_attempt(30),
    message:
        "Fetching the mesh of scene {wildcards.scene}"
    script:
        "../scripts/download_mesh.py"


rule prepare_mesh:
    input:
        source=lambda wildcards: LAYOUT.mesh_source(wildcards.scene),
        code=code("prepare_mesh"),
    output:
        mesh=f"{SCENE}/mesh.ply",
        report=f"{SCENE}/mesh.json",
    log:
        f"{LOGS}/prepare_mesh/{{scene}}.log",
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(10),
    params:
        name=lambda wildcards: CONFIG.mesh_name(wildcards.scene),
    message:
        "Cleaning and normalising the mesh of scene {wildcards.scene}"
    script:
        "../scripts/prepare_mesh.py"


rule preview_scene:
    input:
        mesh=f"{SCENE}/mesh.ply",
        report=f"{SCENE}/mesh.json",
        code=code("preview_scene"),
    output:
        picture=report(
            f"{REPORTS}/scenes/{{scene}}.png",
            caption="../report/scene.rst",
            category="Scenes",
            labels={"scene": "{scene}"},
        ),
    log:
        f"{LOGS}/preview_scene/{{scene}}.log",
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(10),
    params:
        up=lambda wildcards: LAYOUT.scene_param(wildcards.scene, "up"),
        ground=lambda wildcards: LAYOUT.scene_param(wildcards.scene, "ground"),
    message:
        "Drawing scene {wildcards.scene}, its sphere and its quadtree"
    script:
        "../scripts/preview_scene.py"
