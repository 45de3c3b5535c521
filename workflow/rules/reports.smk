"""Tables, figures, claims, the page and the manifest."""


rule table:
    input:
        unpack(lambda wildcards: kinds.table_files(LAYOUT, wildcards.table)),
    output:
        csv=report(
            PATHS.report("{table}.csv"),
            caption="../report/table.rst",
            category="Tables",
            labels=lambda wildcards: kinds.table_labels(LAYOUT, wildcards.table),
        ),
        md=PATHS.report("{table}.md"),
        json=PATHS.report("{table}.json"),
    log:
        PATHS.log("table", "table"),
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=10),
    params:
        code=lambda wildcards: code(
            f"reports/tables/{SETTINGS['tables'][wildcards.table]['kind']}",
            kinds.modules(LAYOUT, "tables", wildcards.table),
        ),
        module=lambda wildcards: kinds.kind_of(
            LAYOUT, "tables", wildcards.table
        ).__name__,
        settings=lambda wildcards: kinds.params(LAYOUT, "tables", wildcards.table),
    message:
        "Writing {wildcards.table}"
    script:
        "../neural_shadows/reports/write_report.py"


rule figure:
    input:
        unpack(lambda wildcards: kinds.files(LAYOUT, "figures", wildcards.figure)),
    output:
        png=report(
            PATHS.report("{figure}.png"),
            caption="../report/figure.rst",
            category="Figures",
            labels=lambda wildcards: kinds.figure_labels(LAYOUT, wildcards.figure),
        ),
        svg=PATHS.report("{figure}.svg"),
    log:
        PATHS.log("figure", "figure"),
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=10),
        gpu=lambda wildcards: GPUS * kinds.uses_gpu(LAYOUT, "figures", wildcards.figure),
    params:
        code=lambda wildcards: code(
            f"reports/figures/{SETTINGS['figures'][wildcards.figure]['kind']}",
            kinds.modules(LAYOUT, "figures", wildcards.figure),
        ),
        module=lambda wildcards: kinds.kind_of(
            LAYOUT, "figures", wildcards.figure
        ).__name__,
        settings=lambda wildcards: kinds.params(LAYOUT, "figures", wildcards.figure),
    message:
        "Drawing {wildcards.figure}"
    script:
        "../neural_shadows/reports/write_report.py"


rule preview_scene:
    input:
        unpack(of(previews.files)),
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
        code=lambda wildcards: code(
            f"reports/drawing/{previews.kind(LAYOUT, wildcards.scene)}",
            previews.modules(LAYOUT, wildcards.scene),
        ),
        kind=of(previews.kind),
        settings=of(previews.settings),
    message:
        "Drawing scene {wildcards.scene}"
    script:
        "../neural_shadows/reports/drawing/{params.kind}.py"


rule claims:
    input:
        **claims.files(LAYOUT),
    output:
        csv=report(
            PATHS.report("claims.csv"),
            caption="../report/claims.rst",
            category="Claims",
            labels={"what": "claims of the texts and their verdicts"},
        ),
        md=PATHS.report("claims.md"),
        json=PATHS.report("claims.json"),
    log:
        PATHS.log("claims"),
    conda:
        ENVIRONMENT
    resources:
        **usual(2000, minutes=10),
    params:
        code=code("reports/claims/write_claims", claims.modules(LAYOUT)),
        settings=claims.arguments(LAYOUT),
    message:
        "Testing the claims"
    script:
        "../neural_shadows/reports/claims/write_claims.py"


rule expected_minutes:
    output:
        csv=PATHS.report("expected_minutes.csv"),
        md=PATHS.report("expected_minutes.md"),
        json=PATHS.report("expected_minutes.json"),
    log:
        PATHS.log("expected_minutes"),
    conda:
        ENVIRONMENT
    # It measures the machine's rates, so nothing runs beside it.
    threads: CORES
    resources:
        **usual(2000, minutes=10),
        gpu=GPUS,
    params:
        code=code("reports/costs/expected_minutes"),
        settings=lambda wildcards: plan(LAYOUT, workflow.rules),
        cores=CORES,
        scale=SETTINGS["scale"],
        device=COMPUTE["device"],
        precision=COMPUTE["precision"],
    message:
        "Estimating the minutes of each report on this machine"
    script:
        "../neural_shadows/reports/costs/expected_minutes.py"


# `index` is the page of a whole run; `available` shows what there is: its reports are params, not
# inputs, so that none is made for it.
rule page:
    input:
        unpack(of(pages.page_inputs)),
        template=files_of("report/page"),
    output:
        html=report(
            PATHS.report("{page}.html"),
            caption="../report/page.rst",
            category="Report",
            labels={"what": "everything on one page, with frames to compare"},
        ),
    log:
        PATHS.log("page", "page"),
    wildcard_constraints:
        page="index|available",
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=10),
    params:
        code=code("reports/page/page", pages.method_modules(LAYOUT)),
        settings=of(pages.page_settings),
        beside=of(pages.newest),
    message:
        "Writing the page {wildcards.page}"
    script:
        "../neural_shadows/reports/page/page.py"


rule manifest:
    input:
        **runs.files(LAYOUT),
    output:
        manifest_json=PATHS.report("manifest.json"),
        crate_json=PATHS.report("ro-crate-metadata.json"),
    log:
        PATHS.log("manifest"),
    conda:
        ENVIRONMENT
    resources:
        **usual(2000, minutes=10),
    params:
        code=code("reports/runs/manifest"),
        settings=lambda wildcards: runs.arguments(LAYOUT),
    message:
        "Writing the manifest"
    script:
        "../neural_shadows/reports/runs/manifest.py"
