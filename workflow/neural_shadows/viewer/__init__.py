"""What leaves for a renderer or a browser: the network as ONNX and how it is asked."""
