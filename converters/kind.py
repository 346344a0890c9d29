"""What the converters have to know of one kind of network: the base class of converters/kinds/*."""


class Kind:
    """One kind of network.  A file in converters/kinds defines a subclass and an object KIND of it;
    converters/reference/<same name>.py defines its PyTorch module, Network."""

    config_type = ""    # its table in the schema's union Config
    optional = ()       # tensors that a file may have beside those of `shapes`
    # Random weights, by the first regular expression that is found in the key:
    gains = {}          # factors on 1 / sqrt(fan in)
    tables = {}         # standard deviations of tables and tokens

    def defaults(self, config):
        """`config`, a new dictionary, with the defaults that a schema cannot state."""
        return config

    def check(self, config):
        """Raises ConvertError for a completed configuration that makes no network."""
        raise NotImplementedError

    def shapes(self, config):
        """key -> shape of every tensor, in the order of the file."""
        raise NotImplementedError

    def streams(self, _config):
        """Columns of every stream that normalisations may name."""
        return {}

    def inputs(self, config, streams):
        """Arrays of plausible size, of numbers from `streams` (converters.inputs.Streams); further
        arguments, with defaults, say how much of them."""
        raise NotImplementedError

    def demo(self):
        """Fields of a network of this kind that let random weights show something."""
        return {}

    def joints(self, _config):
        """Joints of networks that name none."""
        return []

    def features(self, _config):
        """What the front end must be told (the schema's Features), where it is not the default."""
        return {}

    def ast_parts(self, _config):
        """(prefix of keys, configuration) of every AST inside."""
        return []
