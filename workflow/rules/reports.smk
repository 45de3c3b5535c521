"""Tables and figures from the per-view metrics."""


rule table:
    input:
        metrics=lambda wildcards: LAYOUT.table_batches(wildcards.table, "csv"),
        mesh=lambda wildcards: LAYOUT.mesh(LAYOUT.table_scene(wildcards.table), "json"),
        training=lambda wildcards: LAYOUT.table_trainings(wildcards.table),
        depth_biases=lambda wildcards: LAYOUT.table_biases(wildcards.table),
        lpips=f"{RESULTS}/lpips.json",
        published="config/published.csv",
        code=code("write_table"),
        # Not read: so that asking for the table makes its figures too.
        figures=lambda wildcards: LAYOUT.table_figures(wildcards.table),
        preview=lambda wildcards: f"{REPORTS}/scenes/{LAYOUT.table_scene(wildcards.table)}.png",
    output:
        csv=report(
            f"{REPORTS}/{{table}}.csv",
            caption="../report/table.rst",
            category="Tables",
            labels=lambda wildcards: LAYOUT.table_labels(wildcards.table),
        ),
        md=f"{REPORTS}/{{table}}.md",
    log:
        f"{LOGS}/table/{{table}}.log",
    wildcard_constraints:
        table=layout.one_of(LAYOUT.tables_of("comparison")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(2000),
        runtime=per_attempt(10),
    params:
        title=lambda wildcards: CONFIG.tables[wildcards.table].title,
        number=lambda wildcards: CONFIG.tables[wildcards.table].published,
        rows=lambda wildcards: LAYOUT.table_rows(wildcards.table),
        scale=CONFIG.scale,
        width=CONFIG.rendering.width,
        height=CONFIG.rendering.height,
        reference=CONFIG.rendering.reference,
        procedural=lambda wildcards: LAYOUT.is_procedural(
            LAYOUT.table_scene(wildcards.table)
        ),
        seed=lambda wildcards: CONFIG.scene_seed(LAYOUT.table_scene(wildcards.table)),
    message:
        "Writing {wildcards.table}"
    script:
        "../scripts/write_table.py"


rule picture_strip:
    input:
        pictures=lambda wildcards: LAYOUT.first_batches(wildcards.figure, "npz"),
        metrics=lambda wildcards: LAYOUT.first_batches(wildcards.figure, "csv"),
        mesh=lambda wildcards: LAYOUT.mesh(
            LAYOUT.figure_scene(wildcards.figure), "json"
        ),
        code=code("picture_strip"),
    output:
        png=report(
            f"{REPORTS}/{{figure}}.png",
            caption="../report/figure.rst",
            category="Figures",
            labels=lambda wildcards: LAYOUT.figure_labels(wildcards.figure),
        ),
        svg=f"{REPORTS}/{{figure}}.svg",
    log:
        f"{LOGS}/picture_strip/{{figure}}.log",
    wildcard_constraints:
        figure=layout.one_of(LAYOUT.figures_of("pictures")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(10),
    params:
        title=lambda wildcards: CONFIG.figures[wildcards.figure].title,
        rows=lambda wildcards: LAYOUT.picture_rows(wildcards.figure),
        scale=CONFIG.scale,
    message:
        "Drawing the pictures of {wildcards.figure}"
    script:
        "../scripts/picture_strip.py"


rule performance_table:
    input:
        times=lambda wildcards: LAYOUT.frame_times(wildcards.table),
        metrics=lambda wildcards: LAYOUT.table_batches(wildcards.table, "csv"),
        weights=lambda wildcards: LAYOUT.table_files(
            wildcards.table, "weights.safetensors"
        ),
        training=lambda wildcards: LAYOUT.table_trainings(wildcards.table),
        published="config/published.csv",
        code=lambda wildcards: code(
            "performance_table", LAYOUT.table_experiments(wildcards.table)
        ),
    output:
        csv=report(
            f"{REPORTS}/{{table}}.csv",
            caption="../report/table.rst",
            category="Tables",
            labels=lambda wildcards: LAYOUT.table_labels(wildcards.table),
        ),
        md=f"{REPORTS}/{{table}}.md",
    log:
        f"{LOGS}/table/{{table}}.log",
    wildcard_constraints:
        table=layout.one_of(LAYOUT.tables_of("frame_times")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(2000),
        runtime=per_attempt(10),
    params:
        title=lambda wildcards: CONFIG.tables[wildcards.table].title,
        number=lambda wildcards: CONFIG.tables[wildcards.table].published,
        rows=lambda wildcards: LAYOUT.table_rows(wildcards.table),
        scenes=lambda wildcards: LAYOUT.row_scenes(wildcards.table),
        batches=lambda wildcards: LAYOUT.batches_by_scene(wildcards.table),
        networks=lambda wildcards: LAYOUT.table_networks(wildcards.table),
        scale=CONFIG.scale,
        seed=CONFIG.seed,
    message:
        "Writing {wildcards.table}"
    script:
        "../scripts/performance_table.py"


rule networks_table:
    input:
        times=lambda wildcards: LAYOUT.frame_times(wildcards.table),
        metrics=lambda wildcards: LAYOUT.table_batches(wildcards.table, "csv"),
        weights=lambda wildcards: LAYOUT.table_files(
            wildcards.table, "weights.safetensors"
        ),
        training=lambda wildcards: LAYOUT.table_trainings(wildcards.table),
        depth_biases=lambda wildcards: LAYOUT.table_biases(wildcards.table),
        meshes=lambda wildcards: LAYOUT.table_meshes(wildcards.table),
        lpips=f"{RESULTS}/lpips.json",
        code=lambda wildcards: code(
            "networks_table", LAYOUT.table_experiments(wildcards.table)
        ),
    output:
        csv=report(
            f"{REPORTS}/{{table}}.csv",
            caption="../report/table.rst",
            category="Tables",
            labels=lambda wildcards: LAYOUT.table_labels(wildcards.table),
        ),
        md=f"{REPORTS}/{{table}}.md",
    log:
        f"{LOGS}/table/{{table}}.log",
    wildcard_constraints:
        table=layout.one_of(LAYOUT.tables_of("networks")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(10),
    params:
        title=lambda wildcards: CONFIG.tables[wildcards.table].title,
        rows=lambda wildcards: LAYOUT.table_rows(wildcards.table),
        scenes=lambda wildcards: LAYOUT.row_scenes(wildcards.table),
        batches=lambda wildcards: LAYOUT.batches_by_scene(wildcards.table),
        networks=lambda wildcards: LAYOUT.table_networks(wildcards.table),
        procedural=lambda wildcards: {
            scene: LAYOUT.is_procedural(scene)
            for scene in LAYOUT.table_scenes(wildcards.table)
        },
        seeds=lambda wildcards: {
            scene: CONFIG.scene_seed(scene)
            for scene in LAYOUT.table_scenes(wildcards.table)
        },
        given_biases=lambda wildcards: LAYOUT.given_biases(wildcards.table),
        seed=CONFIG.seed,
        scale=CONFIG.scale,
        width=CONFIG.rendering.width,
        height=CONFIG.rendering.height,
        reference=CONFIG.rendering.reference,
    message:
        "Writing {wildcards.table}"
    script:
        "../scripts/networks_table.py"


rule memory_table:
    input:
        mesh=lambda wildcards: LAYOUT.mesh(LAYOUT.memory_scene(wildcards.table), "ply"),
        weights=lambda wildcards: LAYOUT.table_files(
            wildcards.table, "weights.safetensors"
        ),
        published="config/published.csv",
        code=lambda wildcards: code(
            "memory_table", LAYOUT.table_experiments(wildcards.table)
        ),
    output:
        csv=report(
            f"{REPORTS}/{{table}}.csv",
            caption="../report/table.rst",
            category="Tables",
            labels=lambda wildcards: LAYOUT.table_labels(wildcards.table),
        ),
        md=f"{REPORTS}/{{table}}.md",
    log:
        f"{LOGS}/table/{{table}}.log",
    wildcard_constraints:
        table=layout.one_of(LAYOUT.tables_of("memory")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(10),
    params:
        title=lambda wildcards: CONFIG.tables[wildcards.table].title,
        number=lambda wildcards: CONFIG.tables[wildcards.table].published,
        rows=lambda wildcards: LAYOUT.table_rows(wildcards.table),
        networks=lambda wildcards: LAYOUT.table_networks(wildcards.table),
        scale=CONFIG.scale,
    message:
        "Writing {wildcards.table}"
    script:
        "../scripts/memory_table.py"


rule loss_figure:
    input:
        losses=lambda wildcards: LAYOUT.figure_curves(wildcards.figure),
        code=code("loss_figure"),
    output:
        png=report(
            f"{REPORTS}/{{figure}}.png",
            caption="../report/figure.rst",
            category="Figures",
            labels=lambda wildcards: LAYOUT.figure_labels(wildcards.figure),
        ),
        svg=f"{REPORTS}/{{figure}}.svg",
    log:
        f"{LOGS}/loss_figure/{{figure}}.log",
    wildcard_constraints:
        figure=layout.one_of(LAYOUT.figures_of("loss")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(2000),
        runtime=per_attempt(10),
    params:
        title=lambda wildcards: CONFIG.figures[wildcards.figure].title,
        labels=lambda wildcards: [
            curve.label for curve in CONFIG.figures[wildcards.figure].curves
        ],
        scale=CONFIG.scale,
    message:
        "Drawing the loss curves of {wildcards.figure}"
    script:
        "../scripts/loss_figure.py"


rule width_figure:
    input:
        table=lambda wildcards: f"{REPORTS}/{LAYOUT.figure_table(wildcards.figure)}.csv",
        code=code("width_figure"),
    output:
        png=report(
            f"{REPORTS}/{{figure}}.png",
            caption="../report/figure.rst",
            category="Figures",
            labels=lambda wildcards: LAYOUT.figure_labels(wildcards.figure),
        ),
        svg=f"{REPORTS}/{{figure}}.svg",
    log:
        f"{LOGS}/width_figure/{{figure}}.log",
    wildcard_constraints:
        figure=layout.one_of(LAYOUT.figures_of("widths")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(2000),
        runtime=per_attempt(10),
    params:
        title=lambda wildcards: CONFIG.figures[wildcards.figure].title,
        rows=lambda wildcards: LAYOUT.table_rows(LAYOUT.figure_table(wildcards.figure)),
        widths=lambda wildcards: LAYOUT.experiment_widths(wildcards.figure),
        scale=CONFIG.scale,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/width_figure.py"


rule fronts_figure:
    input:
        table=lambda wildcards: f"{REPORTS}/{LAYOUT.figure_table(wildcards.figure)}.csv",
        code=code("fronts_figure"),
    output:
        png=report(
            f"{REPORTS}/{{figure}}.png",
            caption="../report/figure.rst",
            category="Figures",
            labels=lambda wildcards: LAYOUT.figure_labels(wildcards.figure),
        ),
        svg=f"{REPORTS}/{{figure}}.svg",
    log:
        f"{LOGS}/fronts_figure/{{figure}}.log",
    wildcard_constraints:
        figure=layout.one_of(LAYOUT.figures_of("fronts")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(2000),
        runtime=per_attempt(10),
    params:
        title=lambda wildcards: CONFIG.figures[wildcards.figure].title,
        scene=lambda wildcards: CONFIG.figures[wildcards.figure].scene,
        rows=lambda wildcards: LAYOUT.figure_rows(wildcards.figure),
        scale=CONFIG.scale,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/fronts_figure.py"


rule field_slice:
    input:
        mesh=lambda wildcards: LAYOUT.mesh(LAYOUT.field_scene(wildcards.figure), "ply"),
        weights=lambda wildcards: LAYOUT.network(
            CONFIG.figures[wildcards.figure].experiment, "weights.safetensors"
        ),
        code=lambda wildcards: code(
            "field_slice", [CONFIG.figures[wildcards.figure].experiment]
        ),
    output:
        png=report(
            f"{REPORTS}/{{figure}}.png",
            caption="../report/figure.rst",
            category="Figures",
            labels=lambda wildcards: LAYOUT.figure_labels(wildcards.figure),
        ),
        svg=f"{REPORTS}/{{figure}}.svg",
    log:
        f"{LOGS}/field_slice/{{figure}}.log",
    wildcard_constraints:
        figure=layout.one_of(LAYOUT.figures_of("field_slice")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(10),
    params:
        title=lambda wildcards: CONFIG.figures[wildcards.figure].title,
        up=lambda wildcards: LAYOUT.scene_param(
            LAYOUT.field_scene(wildcards.figure), "up"
        ),
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/field_slice.py"


rule method_figure:
    input:
        mesh=lambda wildcards: LAYOUT.mesh(
            CONFIG.figures[wildcards.figure].scene, "ply"
        ),
        report=lambda wildcards: LAYOUT.mesh(
            CONFIG.figures[wildcards.figure].scene, "json"
        ),
        code=code("method_figure"),
    output:
        png=report(
            f"{REPORTS}/{{figure}}.png",
            caption="../report/figure.rst",
            category="Figures",
            labels=lambda wildcards: LAYOUT.figure_labels(wildcards.figure),
        ),
        svg=f"{REPORTS}/{{figure}}.svg",
    log:
        f"{LOGS}/method_figure/{{figure}}.log",
    wildcard_constraints:
        figure=layout.one_of(LAYOUT.figures_of(*layout.METHOD_FIGURES)),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(10),
    params:
        kind=lambda wildcards: CONFIG.figures[wildcards.figure].kind,
        title=lambda wildcards: CONFIG.figures[wildcards.figure].title,
        up=lambda wildcards: LAYOUT.scene_param(
            CONFIG.figures[wildcards.figure].scene, "up"
        ),
        sampling=lambda wildcards: LAYOUT.figure_sampling(wildcards.figure),
        seed=lambda wildcards: CONFIG.scene_seed(CONFIG.figures[wildcards.figure].scene),
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/method_figure.py"


rule claims:
    input:
        metrics=[path for paths in LAYOUT.claim_batches().values() for path in paths],
        losses=list(LAYOUT.claim_losses().values()),
        times=[path for paths in LAYOUT.claim_times().values() for path in paths],
        code=code("write_claims"),
    output:
        csv=report(
            f"{REPORTS}/claims.csv",
            caption="../report/claims.rst",
            category="Claims",
            labels={"what": "claims of the thesis and their verdicts"},
        ),
        md=f"{REPORTS}/claims.md",
    log:
        f"{LOGS}/claims.log",
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(2000),
        runtime=per_attempt(10),
    params:
        claims={name: layout.plain(claim) for name, claim in CONFIG.claims.items()},
        metrics=LAYOUT.claim_batches(),
        scenes={name: LAYOUT.evaluation_scene(name) for name in LAYOUT.claim_batches()},
        losses=LAYOUT.claim_losses(),
        times=LAYOUT.claim_times(),
        scale=CONFIG.scale,
        samples=LAYOUT.most_samples(),
        seed=CONFIG.seed,
    message:
        "Testing the thesis's claims"
    script:
        "../scripts/write_claims.py"


rule html_report:
    input:
        tables=[f"{REPORTS}/{name}.md" for name in LAYOUT.usual_tables()],
        figures=[
            f"{REPORTS}/{name}.{ending}"
            for name in LAYOUT.usual_figures()
            for ending in ("svg", "png")
        ],
        claims=LAYOUT.report_claims(),
        pictures=[
            path
            for paths in LAYOUT.first_batches_by_scene("npz").values()
            for path in paths
        ],
        metrics=[
            path
            for paths in LAYOUT.first_batches_by_scene("csv").values()
            for path in paths
        ],
        meshes=[LAYOUT.mesh(scene, "json") for scene in CONFIG.scenes],
        trainings=[
            LAYOUT.network(name, "training.json")
            for name in LAYOUT.usual_experiments()
        ],
        lpips=f"{RESULTS}/lpips.json",
        page=[
            "workflow/report/page/template.html",
            "workflow/report/page/style.css",
            "workflow/report/page/script.js",
        ],
        code=code("html_report"),
    output:
        html=report(
            f"{REPORTS}/index.html",
            caption="../report/page.rst",
            category="Report",
            labels={"what": "everything on one page, with frames to compare"},
        ),
    log:
        f"{LOGS}/html_report.log",
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(4000),
        runtime=per_attempt(10),
    params:
        scale=CONFIG.scale,
        seed=CONFIG.seed,
        frames=(
            f"{CONFIG.rendering.views_per_set} viewpoints a set at "
            f"{CONFIG.rendering.width} × {CONFIG.rendering.height}"
        ),
        figures={
            f"{REPORTS}/{name}": CONFIG.figures[name].title
            for name in LAYOUT.usual_figures()
        },
        beyond=LAYOUT.beyond(),
        pictures=LAYOUT.first_batches_by_scene("npz"),
        metrics=LAYOUT.first_batches_by_scene("csv"),
        scenes=list(CONFIG.scenes),
        procedural={scene: LAYOUT.is_procedural(scene) for scene in CONFIG.scenes},
        benchmarks=BENCHMARKS,
    message:
        "Writing the report of the run"
    script:
        "../scripts/html_report.py"
