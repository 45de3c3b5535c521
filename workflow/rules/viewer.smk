"""A trained network for renderers."""


rule export_network:
    input:
        unpack(of(LAYOUT.export_files)),
        weights=PATHS.network("weights.safetensors"),
        code=lambda wildcards: code(
            "viewer/export_network", LAYOUT.encodings([wildcards.experiment])
        ),
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
        bias=setting("experiments/{experiment}/bias"),
    message:
        "Exporting {wildcards.experiment} as ONNX"
    script:
        "../neural_shadows/viewer/export_network.py"
