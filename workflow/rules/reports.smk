"""Tables, figures, claims and the page, from what was measured."""


rule table:
    input:
        unpack(of(tables.files)),
    output:
        csv=report(
            PATHS.report("{table}.csv"),
            caption="../report/table.rst",
            category="Tables",
            labels=of(tables.labels),
        ),
        md=PATHS.report("{table}.md"),
    log:
        PATHS.log("table", "table"),
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=10),
    params:
        code=lambda wildcards: code(
            f"reports/tables/{SETTINGS['tables'][wildcards.table]['kind']}",
            tables.encodings(LAYOUT, wildcards.table),
            tables.generators(LAYOUT, wildcards.table),
        ),
        kind=setting("tables/{table}/kind"),
        settings=of(tables.arguments),
    message:
        "Writing {wildcards.table}"
    script:
        "../neural_shadows/reports/tables/{params.kind}.py"


rule figure:
    input:
        unpack(of(figures.files)),
    output:
        png=report(
            PATHS.report("{figure}.png"),
            caption="../report/figure.rst",
            category="Figures",
            labels=of(figures.labels),
        ),
        svg=PATHS.report("{figure}.svg"),
    log:
        PATHS.log("figure", "figure"),
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=10),
        gpu=lambda wildcards: GPUS * figures.asks_networks(LAYOUT, wildcards.figure),
    params:
        code=lambda wildcards: code(
            f"reports/figures/{SETTINGS['figures'][wildcards.figure]['kind']}",
            figures.encodings(LAYOUT, wildcards.figure),
            figures.generators(LAYOUT, wildcards.figure),
        ),
        kind=setting("figures/{figure}/kind"),
        settings=of(figures.arguments),
    message:
        "Drawing {wildcards.figure}"
    script:
        "../neural_shadows/reports/figures/{params.kind}.py"


rule preview_scene:
    input:
        mesh_ply=PATHS.scene("mesh.ply"),
        mesh_json=PATHS.scene("mesh.json"),
    output:
        png=report(
            PATHS.report("scenes/{scene}.png"),
            caption="../report/scene.rst",
            category="Scenes",
            labels={"scene": "{scene}"},
        ),
        svg=PATHS.report("scenes/{scene}.svg"),
    log:
        PATHS.log("preview_scene", "scene"),
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=10),
    params:
        code=code("reports/figures/preview"),
        scene=setting("scenes/{scene}/scene"),
    message:
        "Drawing scene {wildcards.scene}, its sphere and its quadtree"
    script:
        "../neural_shadows/reports/figures/preview.py"


rule claims:
    input:
        **claims.files(LAYOUT),
    output:
        csv=report(
            PATHS.report("claims.csv"),
            caption="../report/claims.rst",
            category="Claims",
            labels={"what": "claims of the thesis and their verdicts"},
        ),
        md=PATHS.report("claims.md"),
    log:
        PATHS.log("claims"),
    conda:
        ENVIRONMENT
    resources:
        **usual(2000, minutes=10),
    params:
        code=code("reports/claims/write_claims"),
        settings=claims.arguments(LAYOUT),
    message:
        "Testing the thesis's claims"
    script:
        "../neural_shadows/reports/claims/write_claims.py"


rule page:
    input:
        **targets.page_files(LAYOUT),
        template=TEMPLATE,
    output:
        html=report(
            PATHS.report("index.html"),
            caption="../report/page.rst",
            category="Report",
            labels={"what": "everything on one page, with frames to compare"},
        ),
    log:
        PATHS.log("page"),
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=10),
    params:
        code=code("reports/page"),
        settings=targets.page_arguments(LAYOUT),
    message:
        "Writing the page of the run"
    script:
        "../neural_shadows/reports/page.py"


# What it shows are params, not inputs: nothing is made, or made again, for it.
use rule page as available with:
    input:
        template=TEMPLATE,
    output:
        html=PATHS.report("available.html"),
    log:
        PATHS.log("available"),
    params:
        code=code("reports/page"),
        settings=of(targets.available_arguments),
        beside=of(targets.newest),
    message:
        "Writing a page of the reports that are there"
