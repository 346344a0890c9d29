"""What trained networks are worth, measured by `infer-cli eval` on what they never saw."""
