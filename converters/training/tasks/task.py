"""What all trainings share: the network, its optimiser, its state."""

import torch

from ... import networks
from ...reference import run as reference
from ..data.dataset import Dataset
from ..optimiser import Optimiser


class BaseTask:
    """A subclass sets `kind`, `options` (names and defaults), and has

        items           what an epoch goes through
        losses(chosen, rng, step)   {"loss": tensor to step down, other names: tensors to show}
        dev(rng)        {"loss": what the best weights have least of, ...} as numbers
        take_pretrained(states)     begins with state_dicts by name, one or more of `pretrained`;
                        how many tensors it took
    """

    kind = ""
    pretrained = ()
    options = {}

    @staticmethod
    def open_data(path):
        return Dataset.open(path)

    def __init__(self, configuration, data, device):
        self.o, self.device, self.data = configuration["options"], device, data
        self.configuration = configuration
        torch.manual_seed(configuration["seed"])
        self.network = networks.complete(self.kind, self.fields(configuration["network"]))
        self.module = reference.new(self.network).float().to(device)
        self.initialise()
        self.optimiser = self.optimiser_of(self.module.parameters())

    def fields(self, given):
        """The network as the configuration has it, with what follows from the data set."""
        return given

    def initialise(self):
        """Where PyTorch's own start would not do."""

    def optimiser_of(self, parameters):
        c = self.configuration
        return Optimiser(parameters, c["optimiser"], c["schedule"], c["clip"])

    def step(self, chosen, rng, step):
        """One step; the losses and the learning rate as numbers."""
        losses = self.losses(chosen, rng, step)
        rate = self.optimiser.step(losses["loss"], step)
        return {**{name: float(x) for name, x in losses.items()}, "rate": rate}

    def dev_items(self):
        raise NotImplementedError

    def dev(self, rng):
        """Mean losses over the development split."""
        sums, batch = {}, self.configuration["batch"]
        items = self.dev_items()
        for at in range(0, len(items), batch):
            chosen = items[at:at + batch]
            for name, x in self.losses(chosen, rng, 1).items():
                sums[name] = sums.get(name, 0.0) + float(x) * len(chosen) / len(items)
        return sums

    def train(self):
        self.module.train()

    def eval(self):
        self.module.eval()

    def weights(self):
        """The state_dict that is exported, on the CPU."""
        return {key: x.detach().cpu().contiguous()
                for key, x in self.module.weights().state_dict().items()}

    def state(self):
        return {"weights": self.module.weights().state_dict(), "optimiser": self.optimiser.state()}

    def load(self, state):
        self.module.weights().load_state_dict(state["weights"])
        self.optimiser.load(state["optimiser"])

    def exports(self):
        """[(name, completed network, state_dict)] of networks beside the one that is trained."""
        return []

    def files(self):
        """{option of export: lines of a file} that travel with the weights."""
        return {}

    def tensor(self, array):
        return torch.from_numpy(array).to(self.device)
