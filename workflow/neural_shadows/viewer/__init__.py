"""Exports: networks as ONNX, and interactive pages."""
