"""References and methods on viewpoints, and times [4.1, 4.4]."""


rule find_lpips:
    input:
        trunk=SETTINGS["metrics"]["lpips"]["trunk"] or [],
    output:
        lpips_json=PATHS.lpips,
    log:
        PATHS.log("find_lpips"),
    # May download: compute nodes of clusters often have no network.
    localrule: True
    conda:
        ENVIRONMENT
    resources:
        **usual(2000, minutes=30),
    params:
        code=code("metrics/find_lpips"),
        net=setting("metrics/lpips/net"),
    message:
        "Finding LPIPS's pretrained backbone"
    script:
        "../neural_shadows/metrics/find_lpips.py"


rule render_references:
    input:
        mesh_ply=PATHS.scene("mesh.ply"),
    output:
        references=PATHS.reference(),
    log:
        PATHS.log("render_references", "scene", "batch"),
    benchmark:
        PATHS.benchmark("render_references", "scene", "batch")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=120),
    params:
        code=code(
            "evaluation/render_references",
            modules=hard_modules([REFERENCES[SETTINGS["rendering"]["reference"]]]),
        ),
        scene=setting("scenes/{scene}/scene"),
        frames=setting("scenes/{scene}/frames"),
        settings=of(LAYOUT.view_range),
        reference=setting("rendering/reference"),
    message:
        "Rendering references of {wildcards.scene}, batch {wildcards.batch}"
    script:
        "../neural_shadows/evaluation/render_references.py"


rule find_depth_bias:
    input:
        references=of(LAYOUT.held_out_views),
        mesh_ply=PATHS.scene("mesh.ply"),
        weights=of(LAYOUT.weights),
    output:
        depth_bias_json=PATHS.depth_bias(),
    log:
        PATHS.log("find_depth_bias", "scene", "method"),
    benchmark:
        PATHS.benchmark("find_depth_bias", "scene", "method")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=60),
        gpu=lambda wildcards: GPUS * LAYOUT.can_use_gpu(wildcards.method),
    params:
        code=lambda wildcards: code(
            "evaluation/find_depth_bias",
            LAYOUT.method_encodings(wildcards.method),
            modules=hard_modules([wildcards.method]),
        ),
        scene=setting("scenes/{scene}/scene"),
        device=COMPUTE["device"],
        precision=COMPUTE["precision"],
    message:
        "Finding the depth bias of {wildcards.method} on {wildcards.scene}"
    script:
        "../neural_shadows/evaluation/find_depth_bias.py"


rule query_network:
    input:
        references=PATHS.reference(),
        weights=of(LAYOUT.weights),
        depth_bias_json=of(LAYOUT.bias_file),
        mesh_ply=PATHS.scene("mesh.ply"),
    output:
        answers=PATHS.answers(),
    log:
        PATHS.log("query_network", "scene", "method", "batch"),
    benchmark:
        PATHS.benchmark("query_network", "scene", "method", "batch")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=60),
        gpu=lambda wildcards: GPUS * LAYOUT.can_use_gpu(wildcards.method),
    params:
        code=lambda wildcards: code(
            "evaluation/query_network", LAYOUT.method_encodings(wildcards.method)
        ),
        bias=of(LAYOUT.bias),
        violations=of(claims.counts_violations),
        device=COMPUTE["device"],
        precision=COMPUTE["precision"],
    message:
        "Querying {wildcards.method} on {wildcards.scene}, batch {wildcards.batch}"
    script:
        "../neural_shadows/evaluation/query_network.py"


rule evaluate:
    input:
        unpack(of(LAYOUT.evaluated_files)),
        references=PATHS.reference(),
        lpips_json=PATHS.lpips,
    output:
        metrics_csv=PATHS.evaluation("csv"),
        visibilities_npz=PATHS.evaluation("npz"),
    log:
        PATHS.log("evaluate", "scene", "method", "batch"),
    benchmark:
        PATHS.benchmark("evaluate", "scene", "method", "batch")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=120),
    params:
        code=lambda wildcards: code(
            "evaluation/evaluate", modules=hard_modules([wildcards.method])
        ),
        scene=setting("scenes/{scene}/scene"),
    message:
        "Evaluating {wildcards.method} on {wildcards.scene}, batch {wildcards.batch}"
    script:
        "../neural_shadows/evaluation/evaluate.py"


rule measure_frame_times:
    input:
        mesh_ply=PATHS.scene("mesh.ply"),
        weights=of(tables.timed_weights),
    output:
        times_json=PATHS.frame_times(),
    log:
        PATHS.log("measure_frame_times", "table", "scene"),
    benchmark:
        PATHS.benchmark("measure_frame_times", "table", "scene")
    conda:
        ENVIRONMENT
    # It computes on one thread; reserving those of a training keeps a small machine undisturbed.
    threads: COMPUTE["threads"]
    resources:
        **usual(4000, minutes=120),
        gpu=GPUS,
    params:
        code=lambda wildcards: code(
            "evaluation/measure_frame_times",
            tables.timed_encodings(LAYOUT, wildcards.table, wildcards.scene),
            modules=hard_modules(
                tables.timed_methods(LAYOUT, wildcards.table, wildcards.scene)
            ),
        ),
        methods=of(tables.timed_methods),
        scene=setting("scenes/{scene}/scene"),
        frames=setting("scenes/{scene}/frames"),
        frame_times=setting("frame_times"),
        device=COMPUTE["device"],
        precision=COMPUTE["precision"],
    message:
        "Timing frames of {wildcards.scene} for {wildcards.table}"
    script:
        "../neural_shadows/evaluation/measure_frame_times.py"
