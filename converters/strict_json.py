"""JSON that stands in files of others: no key twice, no NaN, no depth that breaks the parser."""

import json

from .errors import ConvertError


def parse(data, where):
    """The value that the bytes `data` spell; `where` begins the sentence about what is wrong."""
    def refuse_constant(name):
        raise ConvertError(f"{where}: holds {name}, which is no JSON")

    def unique(pairs):
        found = {}
        for key, value in pairs:
            if key in found:
                raise ConvertError(f"{where}: key {key[:80]!r} is there twice")
            found[key] = value
        return found

    try:
        return json.loads(data.decode("utf-8"), object_pairs_hook=unique,
                          parse_constant=refuse_constant)
    except RecursionError:
        raise ConvertError(f"{where}: nested too deeply") from None
    except ValueError as error:  # of the encoding too
        raise ConvertError(f"{where}: no JSON: {str(error)[:120]}") from None
