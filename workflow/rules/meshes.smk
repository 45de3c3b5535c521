"""Mesh source → clean mesh in normalised space."""


rule get_mesh:
    output:
        source_ply=PATHS.scene("source.ply"),
    log:
        PATHS.log("get_mesh", "scene"),
    benchmark:
        PATHS.benchmark("get_mesh", "scene")
    retries: 2
    # Compute nodes of clusters often have no network, for downloads.
    localrule: True
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=30),
    params:
        code=lambda wildcards: code(
            "meshes/get_mesh", [LAYOUT.mesh_module(wildcards.scene)]
        ),
        mesh=setting("scenes/{scene}/mesh"),
    message:
        "Generating or downloading the mesh of scene {wildcards.scene}"
    script:
        "../neural_shadows/meshes/get_mesh.py"


rule prepare_mesh:
    input:
        source=of(LAYOUT.mesh_source),
    output:
        mesh_ply=PATHS.scene("mesh.ply"),
        mesh_json=PATHS.scene("mesh.json"),
    log:
        PATHS.log("prepare_mesh", "scene"),
    benchmark:
        PATHS.benchmark("prepare_mesh", "scene")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=10),
    params:
        code=code("meshes/prepare_mesh"),
        mesh=setting("scenes/{scene}/mesh"),
        name=setting("scenes/{scene}/mesh_name"),
    message:
        "Cleaning and normalising the mesh of scene {wildcards.scene}"
    script:
        "../neural_shadows/meshes/prepare_mesh.py"
