"""One golden."""

import dataclasses

from .. import networks


@dataclasses.dataclass
class Case:
    name: str
    about: str
    kind: str
    fields: dict                # of its network
    sizes: dict = dataclasses.field(default_factory=dict)    # of its inputs
    options: dict = dataclasses.field(default_factory=dict)  # of the run
    optional: dict = dataclasses.field(default_factory=dict)  # tensors beside the weights
    untapped: tuple = ()        # taps to leave out, by how their names begin
    self_test: bool = True

    def network(self):
        return networks.complete(self.kind, self.fields)
