"""Tables and figures from the per-view metrics."""


rule table:
    input:
        metrics=lambda wildcards: LAYOUT.table_batches(wildcards.table, "csv"),
        mesh=lambda wildcards: LAYOUT.mesh(LAYOUT.table_scene(wildcards.table), "json"),
        training=lambda wildcards: LAYOUT.table_networks(
            wildcards.table, "training.json"
        ),
        lpips=f"{RESULTS}/lpips.json",
        published="config/published.csv",
        code=code("write_table"),
        # Not read: so that asking for the table makes its figures too.
        figures=lambda wildcards: LAYOUT.table_figures(wildcards.table),
        preview=lambda wildcards: f"{REPORTS}/scenes/{LAYOUT.table_scene(wildcards.table)}.png",
    output:
        csv=f"{REPORTS}/{{table}}.csv",
        md=f"{REPORTS}/{{table}}.md",
    log:
        f"{LOGS}/table/{{table}}.log",
    wildcard_constraints:
        table=layout.one_of(LAYOUT.tables_of("comparison")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=2000,
        runtime=10,
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
            LAYOUT.table_scene(LAYOUT.pictures_table(wildcards.figure)), "json"
        ),
        code=code("picture_strip"),
    output:
        png=f"{REPORTS}/{{figure}}.png",
        svg=f"{REPORTS}/{{figure}}.svg",
    log:
        f"{LOGS}/picture_strip/{{figure}}.log",
    wildcard_constraints:
        figure=layout.one_of(LAYOUT.figures_of("pictures")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=4000,
        runtime=10,
    params:
        title=lambda wildcards: CONFIG.figures[wildcards.figure].title,
        rows=lambda wildcards: LAYOUT.table_rows(
            LAYOUT.pictures_table(wildcards.figure)
        ),
        scale=CONFIG.scale,
    message:
        "Drawing the pictures of {wildcards.figure}"
    script:
        "../scripts/picture_strip.py"
