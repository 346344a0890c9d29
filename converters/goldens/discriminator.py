"""Cases of the discriminator."""

from .case import Case

SMALL = {"rows": 4, "d_content": 10, "d_style": 9, "hidden": 8}

CASES = [
    Case("discriminator_mean", "discriminator, all defaults", "discriminator", {"config": SMALL},
         sizes={"segments": 3}),
    Case("discriminator_first", "its first row, two hidden layers", "discriminator",
         {"config": {**SMALL, "pool": "First", "layers": 2, "alpha": 0.1}}, sizes={"segments": 2}),
    Case("discriminator_last", "its last row, no hidden layer", "discriminator",
         {"config": {**SMALL, "pool": "Last", "layers": 0}}, sizes={"segments": 2}),
]
