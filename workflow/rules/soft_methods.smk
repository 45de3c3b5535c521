"""Methods for soft shadows: their constants, errors and times."""


rule fit_fields:
    input:
        parts=of(soft_methods.fitted_parts),
        beside=of(soft_methods.fitted_arrays),
        meshes=of(soft_methods.all_meshes),
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
            generators=soft_methods.all_generators(LAYOUT, wildcards.frame_set),
        ),
    message:
        "Fitting fields to the objects of {wildcards.frame_set}"
    script:
        "../neural_shadows/evaluation/fit_fields.py"


rule tune_soft_method:
    input:
        parts=of(soft_methods.validations),
        fields=of(soft_methods.fields),
        beside=of(soft_methods.tuned_arrays),
        meshes=of(soft_methods.all_meshes),
    output:
        constants_json=PATHS.soft_constants(),
    log:
        PATHS.log("tune_soft_method", "frame_set", "method"),
    benchmark:
        PATHS.benchmark("tune_soft_method", "frame_set", "method")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=120),
    params:
        code=lambda wildcards: code(
            "evaluation/tune_soft_method",
            generators=soft_methods.all_generators(LAYOUT, wildcards.frame_set),
            methods=[wildcards.method],
        ),
    message:
        "Choosing the constants of {wildcards.method} on {wildcards.frame_set}"
    script:
        "../neural_shadows/evaluation/tune_soft_method.py"


rule measure_widths:
    input:
        parts=of(soft_methods.tests),
        beside=of(soft_methods.tested_arrays),
    output:
        widths_json=PATHS.penumbra_widths(),
    log:
        PATHS.log("measure_widths", "frame_set"),
    benchmark:
        PATHS.benchmark("measure_widths", "frame_set")
    conda:
        ENVIRONMENT
    resources:
        **usual(2000, minutes=30),
    params:
        code=code("evaluation/measure_widths"),
    message:
        "Measuring widths of penumbrae in {wildcards.frame_set}"
    script:
        "../neural_shadows/evaluation/measure_widths.py"


rule measure_occluders:
    input:
        parts=PATHS.frames("json"),
        beside=frame_sets.arrays([PATHS.frames("json")]),
        meshes=of(frame_sets.meshes),
    output:
        occluders_npy=PATHS.occluders(),
    log:
        PATHS.log("measure_occluders", "scene", "frame_set", "part"),
    benchmark:
        PATHS.benchmark("measure_occluders", "scene", "frame_set", "part")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=60),
    params:
        code=lambda wildcards: code(
            "evaluation/measure_occluders",
            generators=frame_sets.generators(LAYOUT, [wildcards.scene]),
        ),
    message:
        "Measuring occluders in {wildcards.part} of {wildcards.scene} for {wildcards.frame_set}"
    script:
        "../neural_shadows/evaluation/measure_occluders.py"


rule evaluate_soft:
    input:
        parts=of(soft_methods.tests),
        occluders=of(soft_methods.occluders),
        fields=of(soft_methods.fields),
        beside=of(soft_methods.measured_arrays),
        sequences=of(soft_methods.sequences),
        meshes=of(soft_methods.all_meshes),
        constants_json=of(soft_methods.chosen),
        weights=of(soft_methods.weights),
        lpips_json=PATHS.lpips,
    output:
        metrics_csv=PATHS.soft_evaluation("csv"),
        answers_npz=PATHS.soft_evaluation("npz"),
    log:
        PATHS.log("evaluate_soft", "frame_set", "method"),
    benchmark:
        PATHS.benchmark("evaluate_soft", "frame_set", "method")
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=120),
    params:
        code=lambda wildcards: code(
            "evaluation/evaluate_soft",
            generators=soft_methods.all_generators(LAYOUT, wildcards.frame_set),
            methods=[wildcards.method],
            forms=soft_methods.forms(LAYOUT, [wildcards.method]),
        ),
        precision=of(soft_methods.precision),
        by_scene=of(soft_methods.by_scene),
    message:
        "Evaluating {wildcards.method} on {wildcards.frame_set}"
    script:
        "../neural_shadows/evaluation/evaluate_soft.py"


rule answer_frames:
    input:
        parts=of(soft_methods.tests),
        beside=of(soft_methods.tested_arrays),
        meshes=of(soft_methods.all_meshes),
        constants_json=of(soft_methods.chosen),
        weights=of(soft_methods.weights),
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
            generators=soft_methods.all_generators(LAYOUT, wildcards.frame_set),
            methods=[wildcards.method],
            forms=soft_methods.forms(LAYOUT, [wildcards.method]),
        ),
        label=of(soft_methods.label),
        by_scene=of(soft_methods.by_scene),
    message:
        "Evaluating {wildcards.method} on the frames of {wildcards.frame_set}"
    script:
        "../neural_shadows/reports/answers/answer_frames.py"


rule time_soft_methods:
    input:
        parts=of(soft_methods.timed_parts),
        constants=of(soft_methods.constants),
        weights=of(soft_methods.timed_weights),
        fields=of(soft_methods.timed_fields),
        meshes=of(soft_methods.timed_meshes),
    output:
        times_json=PATHS.soft_times(),
    log:
        PATHS.log("time_soft_methods", "table"),
    benchmark:
        PATHS.benchmark("time_soft_methods", "table")
    conda:
        ENVIRONMENT
    # It computes on one thread; reserving those of a training keeps a small machine undisturbed.
    threads: COMPUTE["threads"]
    resources:
        **usual(4000, minutes=120),
    params:
        code=lambda wildcards: code(
            "evaluation/time_soft_methods",
            generators=soft_methods.timed_generators(LAYOUT, wildcards.table),
            methods=soft_methods.methods(LAYOUT, wildcards.table),
            forms=soft_methods.forms(
                LAYOUT, soft_methods.methods(LAYOUT, wildcards.table)
            ),
        ),
        methods=of(soft_methods.timed_methods),
    message:
        "Timing the methods of {wildcards.table}"
    script:
        "../neural_shadows/evaluation/time_soft_methods.py"
