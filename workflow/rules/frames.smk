"""Frames of scenes in metres: buffers, and the exact soft shadows of lights of several radii."""


rule render_frames:
    input:
        meshes=of(frame_sets.meshes),
        code=lambda wildcards: code(
            "frames/render_frames",
            generators=frame_sets.generators(LAYOUT, [wildcards.scene]),
        ),
    output:
        frames_json=PATHS.frames("json"),
        buffers_npy=PATHS.frames("buffers.npy"),
        targets_npy=PATHS.frames("targets.npy"),
        valid_npy=PATHS.frames("valid.npy"),
    log:
        PATHS.log("render_frames", "scene", "frame_set", "part"),
    benchmark:
        PATHS.benchmark("render_frames", "scene", "frame_set", "part")
    conda:
        ENVIRONMENT
    threads: COMPUTE["threads"]
    resources:
        **usual(4000, minutes=120),
    params:
        settings=of(frame_sets.frame_settings),
    message:
        "Rendering frames {wildcards.part} of {wildcards.scene} for {wildcards.frame_set}"
    script:
        "../neural_shadows/frames/render_frames.py"
