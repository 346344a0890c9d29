"""The one error that the converters report to the user: a sentence, without a traceback."""


class ConvertError(Exception):
    """What is wrong, where, what was found and what was expected, in one sentence."""
