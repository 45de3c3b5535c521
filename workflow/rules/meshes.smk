"""Mesh source → clean mesh in normalised space."""


rule generate_mesh:
    output:
        generated_ply=PATHS.scene("generated.ply"),
    log:
        PATHS.log("generate_mesh", "scene"),
    benchmark:
        PATHS.benchmark("generate_mesh", "scene")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=10),
    params:
        code=code("meshes/generate_mesh"),
        mesh=setting("scenes/{scene}/mesh"),
    message:
        "Generating the mesh of scene {wildcards.scene}"
    script:
        "../neural_shadows/meshes/generate_mesh.py"


rule download_mesh:
    output:
        downloaded_ply=PATHS.scene("downloaded.ply"),
    log:
        PATHS.log("download_mesh", "scene"),
    retries: 2
    # Compute nodes of clusters often have no network.
    localrule: True
    conda:
        ENVIRONMENT
    resources:
        **usual(1000, minutes=30),
    params:
        code=code("meshes/download_mesh"),
    message:
        "Downloading the mesh of scene {wildcards.scene}"
    script:
        "../neural_shadows/meshes/download_mesh.py"


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
