"""gestus beside ONNX Runtime and PyTorch, interleaved in one run on the same weights and inputs."""
