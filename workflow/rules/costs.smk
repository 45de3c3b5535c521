"""How the cost of each stage grows with each size."""


rule measure_cost:
    input:
        code=code("measure_cost", encodings=["frequency"]),
    output:
        cost=f"{RESULTS}/{layout.COST}",
    log:
        f"{LOGS}/measure_cost/{{over}}.{{value}}.log",
    benchmark:
        f"{BENCHMARKS}/measure_cost/{{over}}.{{value}}.tsv"
    conda:
        ENVIRONMENT
    # All that a training takes, so that nothing disturbs it on a small machine.
    threads: CONFIG.compute.threads
    resources:
        mem_mb=per_attempt(8000),
        runtime=per_attempt(120),
        gpu=GPUS,
    params:
        seed=CONFIG.seed,
        device=CONFIG.compute.device,
        precision=CONFIG.compute.precision,
    message:
        "Measuring costs at {wildcards.over} = {wildcards.value}"
    script:
        "../scripts/measure_cost.py"


rule cost_table:
    input:
        costs=lambda wildcards: LAYOUT.costs(wildcards.table),
        code=code("cost_table"),
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
        table=layout.one_of(LAYOUT.tables_of("cost")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(2000),
        runtime=per_attempt(10),
    params:
        title=lambda wildcards: CONFIG.tables[wildcards.table].title,
        scale=CONFIG.scale,
    message:
        "Writing {wildcards.table}"
    script:
        "../scripts/cost_table.py"


rule cost_figure:
    input:
        costs=lambda wildcards: LAYOUT.costs(LAYOUT.figure_table(wildcards.figure)),
        code=code("cost_figure"),
    output:
        png=report(
            f"{REPORTS}/{{figure}}.png",
            caption="../report/figure.rst",
            category="Figures",
            labels=lambda wildcards: LAYOUT.figure_labels(wildcards.figure),
        ),
        svg=f"{REPORTS}/{{figure}}.svg",
    log:
        f"{LOGS}/cost_figure/{{figure}}.log",
    wildcard_constraints:
        figure=layout.one_of(LAYOUT.figures_of("cost")),
    conda:
        ENVIRONMENT
    threads: 1
    resources:
        mem_mb=per_attempt(2000),
        runtime=per_attempt(10),
    params:
        title=lambda wildcards: CONFIG.figures[wildcards.figure].title,
        scale=CONFIG.scale,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/cost_figure.py"
