"""Methods on views and frames: references, constants, metrics, times [4.1, 4.4]."""


rule find_lpips:
    input:
        trunk=SETTINGS["metrics"]["lpips"]["trunk"] or [],
    output:
        lpips_json=PATHS.lpips,
        lpips_onnx=PATHS.lpips_model,
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
            method_modules([REFERENCES[LAYOUT.views.reference]]),
        ),
        scene=setting("scenes/{scene}/scene"),
        frames=setting("scenes/{scene}/frames"),
        settings=of(LAYOUT.view_range),
        reference=setting("frame_sets/views/reference"),
    message:
        "Rendering references of {wildcards.scene}, batch {wildcards.batch}"
    script:
        "../neural_shadows/evaluation/render_references.py"


rule tune:
    input:
        unpack(of(evaluations.tuned_files)),
    output:
        constants_json=PATHS.constants(),
    log:
        PATHS.log("tune", "frame_set", "group", "method"),
    benchmark:
        PATHS.benchmark("tune", "frame_set", "group", "method")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=120),
        gpu=lambda wildcards: GPUS
        * evaluations.can_use_gpu(LAYOUT, wildcards.frame_set, wildcards.method),
    params:
        code=lambda wildcards: code(
            "evaluation/tune",
            evaluations.modules(
                LAYOUT, "tune", wildcards.frame_set, [wildcards.method]
            ),
        ),
        settings=of(evaluations.tuned_settings),
    message:
        "Choosing the constants of {wildcards.method} on {wildcards.frame_set}, {wildcards.group}"
    script:
        "../neural_shadows/evaluation/tune.py"


rule evaluate:
    input:
        unpack(of(evaluations.evaluated_files)),
        PATHS.lpips_model,  # read beside its JSON
        lpips_json=PATHS.lpips,
    output:
        metrics_csv=PATHS.evaluation("csv"),
        answers_npz=PATHS.evaluation("npz"),
    log:
        PATHS.log("evaluate", "frame_set", "group", "method"),
    benchmark:
        PATHS.benchmark("evaluate", "frame_set", "group", "method")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=120),
        gpu=lambda wildcards: GPUS
        * evaluations.can_use_gpu(LAYOUT, wildcards.frame_set, wildcards.method),
    params:
        code=lambda wildcards: code(
            "evaluation/evaluate",
            evaluations.modules(
                LAYOUT, "evaluate", wildcards.frame_set, [wildcards.method]
            ),
        ),
        settings=of(evaluations.evaluated_settings),
    message:
        "Evaluating {wildcards.method} on {wildcards.frame_set}, {wildcards.group}"
    script:
        "../neural_shadows/evaluation/evaluate.py"


rule count_violations:
    input:
        references=PATHS.reference(),
        weights=of(LAYOUT.weights),
        constants_json=of(LAYOUT.bias_file),
        mesh_ply=PATHS.scene("mesh.ply"),
    output:
        violations_csv=PATHS.violations(),
    log:
        PATHS.log("count_violations", "scene", "method", "batch"),
    benchmark:
        PATHS.benchmark("count_violations", "scene", "method", "batch")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=60),
        gpu=lambda wildcards: GPUS * LAYOUT.can_use_gpu(wildcards.method),
    params:
        code=lambda wildcards: code(
            "evaluation/count_violations",
            LAYOUT.network_modules([unbiased(wildcards.method)]),
        ),
        bias=of(LAYOUT.fixed_bias),
        device=COMPUTE["device"],
        precision=COMPUTE["precision"],
    message:
        "Counting the violations of {wildcards.method} on {wildcards.scene}, batch {wildcards.batch}"
    script:
        "../neural_shadows/evaluation/count_violations.py"


rule time_methods:
    input:
        unpack(of(evaluations.timed_files)),
    output:
        times_json=PATHS.times(),
    log:
        PATHS.log("time_methods", "table", "group"),
    benchmark:
        PATHS.benchmark("time_methods", "table", "group")
    conda:
        ENVIRONMENT
    # It computes on one thread; the others keep a small machine undisturbed.
    threads: COMPUTE["timing_cores"]
    resources:
        **usual(4000, minutes=120),
        gpu=lambda wildcards: GPUS * evaluations.on_views(LAYOUT, wildcards.table),
    params:
        code=lambda wildcards: code(
            "evaluation/time_methods",
            evaluations.timed_modules(LAYOUT, wildcards.table, wildcards.group),
        ),
        settings=of(evaluations.timed_settings),
    message:
        "Timing the methods of {wildcards.table}, {wildcards.group}"
    script:
        "../neural_shadows/evaluation/time_methods.py"


rule measure_sun_hours:
    input:
        mesh_ply=PATHS.scene("mesh.ply"),
    output:
        hours_npz=PATHS.sun_hours("npz"),
        hours_json=PATHS.sun_hours("json"),
    log:
        PATHS.log("measure_sun_hours", "table", "scene"),
    benchmark:
        PATHS.benchmark("measure_sun_hours", "table", "scene")
    conda:
        ENVIRONMENT
    # It computes on one thread; the others keep a small machine undisturbed.
    threads: COMPUTE["timing_cores"]
    resources:
        **usual(4000, minutes=60),
    params:
        code=code("evaluation/measure_sun_hours"),
        settings=of(sun_hours.settings),
    message:
        "Measuring hours of sun of {wildcards.table}, {wildcards.scene}"
    script:
        "../neural_shadows/evaluation/measure_sun_hours.py"


rule fit_fields:
    input:
        parts=of(frame_sets.fitted_parts),
        meshes=of(frame_sets.tuned_meshes),
    output:
        fields_npz=PATHS.soft_fields(),
    log:
        PATHS.log("fit_fields", "frame_set"),
    benchmark:
        PATHS.benchmark("fit_fields", "frame_set")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=60),
    params:
        code=lambda wildcards: code(
            "evaluation/fit_fields",
            frame_sets.fitted_generators(LAYOUT, wildcards.frame_set),
        ),
    message:
        "Fitting fields to the objects of {wildcards.frame_set}"
    script:
        "../neural_shadows/evaluation/fit_fields.py"


rule measure_frames:
    input:
        parts=of(frame_sets.tests),
        beside=of(frame_sets.tested_arrays),
        meshes=of(frame_sets.all_meshes),
    output:
        output=PATHS.frame_measure(),
    log:
        PATHS.log("measure_frames", "frame_set", "measure"),
    benchmark:
        PATHS.benchmark("measure_frames", "frame_set", "measure")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=120),
    params:
        code=lambda wildcards: code(
            "evaluation/measure_frames",
            frame_sets.modules(LAYOUT, wildcards.frame_set),
        ),
    message:
        "Measuring {wildcards.measure} of the frames of {wildcards.frame_set}"
    script:
        "../neural_shadows/evaluation/measure_frames.py"


rule answer_frames:
    input:
        parts=of(frame_sets.tests),
        beside=of(frame_sets.tested_arrays),
        meshes=of(frame_sets.all_meshes),
        constants_json=of(frame_methods.chosen),
        weights=of(frame_methods.weights),
    output:
        errors_csv=PATHS.report("answers/{frame_set}/{method}.csv"),
        answers=directory(PATHS.report("answers/{frame_set}/{method}")),
    log:
        PATHS.log("answer_frames", "frame_set", "method"),
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=120),
    params:
        code=lambda wildcards: code(
            "reports/answers/answer_frames",
            evaluations.modules(
                LAYOUT, "answer_frames", wildcards.frame_set, [wildcards.method]
            ),
        ),
        label=of(frame_methods.label),
        by_scene=of(frame_methods.by_scene),
    message:
        "Evaluating {wildcards.method} on the frames of {wildcards.frame_set}"
    script:
        "../neural_shadows/reports/answers/answer_frames.py"
