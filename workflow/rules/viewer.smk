"""Exports: networks as ONNX, and scenes with a movable light."""


rule export_network:
    input:
        unpack(of(LAYOUT.export_files)),
        weights=PATHS.network("weights.safetensors"),
    output:
        network_onnx=PATHS.network("network.onnx"),
        network_json=PATHS.network("network.json"),
    log:
        PATHS.log("export_network", "experiment"),
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=30),
    params:
        code=lambda wildcards: code(
            "viewer/export_network", LAYOUT.network_modules([wildcards.experiment])
        ),
        bias=setting("experiments/{experiment}/bias"),
    message:
        "Exporting {wildcards.experiment} as ONNX"
    script:
        "../neural_shadows/viewer/export_network.py"


rule viewer:
    input:
        unpack(of(viewers.files)),
        template=lambda wildcards: VIEWERS[viewers.stage(LAYOUT, wildcards.viewer)],
    output:
        html=report(
            PATHS.report("{viewer}.html"),
            caption="../report/viewer.rst",
            category="Report",
            labels=of(viewers.labels),
        ),
        png=PATHS.report("{viewer}.png"),
    log:
        PATHS.log("viewer", "viewer"),
    conda:
        ENVIRONMENT
    resources:
        **usual(4000, minutes=10),
    params:
        code=lambda wildcards: code(
            f"viewer/{viewers.stage(LAYOUT, wildcards.viewer)}",
            viewers.modules(LAYOUT, wildcards.viewer),
        ),
        kind=of(viewers.stage),
        settings=of(viewers.arguments),
    message:
        "Writing {wildcards.viewer}: a scene with a movable light"
    script:
        "../neural_shadows/viewer/{params.kind}.py"
