"""Frames of scenes in metres: buffers and exact soft shadows."""


rule render_frames:
    input:
        meshes=of(frame_sets.meshes),
    output:
        frames_json=PATHS.frames("json"),
        buffers_npy=PATHS.frames("buffers.npy"),
        targets_npy=PATHS.frames("targets.npy"),
        valid_npy=PATHS.frames("valid.npy"),
        edges_npy=PATHS.frames("edges.npy"),
        rays_npy=PATHS.frames("rays.npy"),
    log:
        PATHS.log("render_frames", "scene", "frame_set", "part"),
    benchmark:
        PATHS.benchmark("render_frames", "scene", "frame_set", "part")
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        **usual(4000, minutes=120),
    params:
        code=lambda wildcards: code(
            "frames/render_frames",
            frame_sets.modules(LAYOUT, wildcards.frame_set, [wildcards.scene]),
        ),
        settings=of(frame_sets.frame_settings),
    message:
        "Rendering frames {wildcards.part} of {wildcards.scene} for {wildcards.frame_set}"
    script:
        "../neural_shadows/frames/render_frames.py"


rule import_frame:
    input:
        files=of(frame_sets.engine_files),
    output:
        frames_json=PATHS.imported_frames("json"),
        buffers_npy=PATHS.imported_frames("buffers.npy"),
        targets_npy=PATHS.imported_frames("targets.npy"),
        valid_npy=PATHS.imported_frames("valid.npy"),
    log:
        PATHS.log("import_frame", "scene", "frame_set", "part"),
    benchmark:
        PATHS.benchmark("import_frame", "scene", "frame_set", "part")
    wildcard_constraints:
        scene="[^/.]+",
    conda:
        ENVIRONMENT
    resources:
        **usual(2000, minutes=10),
    params:
        code=code("frames/import_frame"),
        settings=of(frame_sets.import_settings),
    message:
        "Importing frame {wildcards.part} of {wildcards.scene} for {wildcards.frame_set}"
    script:
        "../neural_shadows/frames/import_frame.py"
