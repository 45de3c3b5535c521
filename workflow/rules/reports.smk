"""Tables and figures from the per-view metrics."""


rule table:
    input:
        metrics=lambda wildcards: LAYOUT.batches(
            LAYOUT.table_evaluation(wildcards.table), "csv"
        ),
        mesh=lambda wildcards: LAYOUT.mesh(LAYOUT.table_scene(wildcards.table), "json"),
        training=lambda wildcards: LAYOUT.networks(
            LAYOUT.table_evaluation(wildcards.table), "training.json"
        ),
        lpips=f"{RESULTS}/lpips.json",
        published="config/published.csv",
        code=code("write_table"),
        # Not read: so that asking for the table makes its pictures too.
        pictures=f"{REPORTS}/{{table}}_pictures.png",
        preview=lambda wildcards: f"{REPORTS}/scenes/{LAYOUT.table_scene(wildcards.table)}.png",
    output:
        csv=f"{REPORTS}/{{table}}.csv",
        md=f"{REPORTS}/{{table}}.md",
    log:
        f"{LOGS}/table/{{table}}.log",
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
        pictures=lambda wildcards: LAYOUT.first_batches(
            LAYOUT.table_evaluation(wildcards.table), "npz"
        ),
        metrics=lambda wildcards: LAYOUT.first_batches(
            LAYOUT.table_evaluation(wildcards.table), "csv"
        ),
        mesh=lambda wildcards: LAYOUT.mesh(LAYOUT.table_scene(wildcards.table), "json"),
        code=code("picture_strip"),
    output:
        png=f"{REPORTS}/{{table}}_pictures.png",
        svg=f"{REPORTS}/{{table}}_pictures.svg",
    log:
        f"{LOGS}/picture_strip/{{table}}.log",
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=4000,
        runtime=10,
    params:
        title=lambda wildcards: CONFIG.tables[wildcards.table].title,
        rows=lambda wildcards: LAYOUT.table_rows(wildcards.table),
        scale=CONFIG.scale,
    message:
        "Drawing the pictures of {wildcards.table}"
    script:
        "../scripts/picture_strip.py"
