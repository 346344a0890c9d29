"""What became of every tensor of a checkpoint: used, unused, missing."""

import json


class Report:
    def __init__(self, checkpoint, network):
        self.head = {"checkpoint": checkpoint.name, "format": checkpoint.format,
                     "network": network["name"], "config_type": network["config_type"]}
        self.notes = list(checkpoint.notes)
        self.used = {}      # our key -> where it comes from
        self.unused = {}    # their key -> (shape or None, why or None)
        self.missing = {}   # our key -> (shape, why)
        self.misshapen = {}  # our key -> (shape or dtype found, shape or dtype expected)

    def append(self, note):
        self.notes.append(note)

    @property
    def counts(self):
        return (f"tensors: {len(self.used)} used, {len(self.unused)} unused, "
                f"{len(self.missing)} missing, {len(self.misshapen)} misshapen")

    def lines(self):
        """What `export` prints."""
        yield from self.notes
        yield self.counts
        for key, (shape, why) in self.unused.items():
            yield f"unused: {key}" + (f" {shape}" if shape is not None else "") + (
                f", {why}" if why else "")
        for key, (shape, why) in self.missing.items():
            yield f"missing: {key} {shape}" + (f", {why}" if why else "")
        for key, (found, expected) in self.misshapen.items():
            yield f"misshapen: {key} {found}, expected {expected}"

    def write(self, path):
        """As JSON where the name says so, else as text."""
        if str(path).endswith(".json"):
            unused = {key: {"shape": shape and list(shape), "why": why}
                      for key, (shape, why) in self.unused.items()}
            missing = {key: {"shape": list(shape), "why": why}
                       for key, (shape, why) in self.missing.items()}
            misshapen = {key: {"found": str(found), "expected": str(expected)}
                         for key, (found, expected) in self.misshapen.items()}
            text = json.dumps({**self.head, "notes": self.notes, "used": self.used,
                               "unused": unused, "missing": missing, "misshapen": misshapen},
                              indent=1)
        else:
            used = (f"used: {ours} from {', '.join(theirs)}" for ours, theirs in self.used.items())
            text = "\n".join([*(f"{key}: {value}" for key, value in self.head.items()),
                              *self.lines(), *used])
        with open(path, "w", encoding="utf-8") as file:
            file.write(text + "\n")
