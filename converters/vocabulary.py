"""Files that travel with BERT: the vocabulary of its tokens, and the names of its classes."""

import numpy as np

from .errors import ConvertError

MAX_BYTES = 16 << 20  # as the engine's
NEEDED = ("[UNK]", "[CLS]", "[SEP]", "[PAD]")

# SwDA's tags by DialogTag's class index (features.md, section 5.6); its label_map.txt gives names to
# tags, in an order of its own.
DIALOG_TAGS = (
    'fo_o_fw_"_by_bc', "ft", "fc", "qw", "^g", "bh", "qy", "qrr", "fp", "qo", "bk", "h", "sv", "ba",
    "nn", "^h", "^2", "aap_am", "qw^d", "qy^d", "ng", "fa", "b", "ny", "t3", "sd", "br", "oo_co_cc",
    "arp_nd", "t1", "^q", "aa", "na", "b^m", "bd", "ad", "bf", "qh")


def read_vocabulary(path, tokens):
    """The tensor `vocabulary` of a vocab.txt with one token a line, `tokens` of them."""
    lines = _lines(path)
    first = {}
    for number, line in enumerate(lines, 1):
        if not line:
            raise ConvertError(f"{path}: line {number} is empty, expected a token")
        if first.setdefault(line, number) != number:
            raise ConvertError(f"{path}: line {number} repeats the token of line {first[line]}")
    if len(lines) != tokens:
        raise ConvertError(f"{path}: {len(lines)} lines, expected {tokens} as in config.tokens")
    for token in NEEDED:
        if token not in first:
            raise ConvertError(f"{path}: {token} is missing, expected {', '.join(NEEDED)}")
    if first["[PAD]"] != 1:
        raise ConvertError(f"{path}: [PAD] in line {first['[PAD]']}, expected it in the first")
    return np.frombuffer("\n".join(lines).encode(), np.uint8)


def read_labels(path):
    """Names of classes: one a line in the order of the outputs, or "name|tag" with DialogTag's tags
    or numbers of classes."""
    lines = [line for line in _lines(path) if line]
    pairs = [line.rpartition("|") for line in lines]
    if not lines:
        raise ConvertError(f"{path}: empty, expected one label a line")
    if not all(bar for _, bar, _ in pairs):
        if any(bar for _, bar, _ in pairs):
            raise ConvertError(f"{path}: some lines are \"name|tag\" and some are not")
        return lines
    names = {}
    for name, _, tag in pairs:
        if names.setdefault(tag.strip(), name.strip()) != name.strip():
            raise ConvertError(f"{path}: tag {tag.strip()!r} is there twice")
    numbers = [str(n) for n in range(len(names))]
    order = numbers if set(names) == set(numbers) else DIALOG_TAGS
    for tag in order:
        if tag not in names:
            raise ConvertError(f"{path}: tag {tag!r} of class {order.index(tag)} is missing")
    return [names[tag] for tag in order]


def _lines(path):
    with open(path, "rb") as file:
        data = file.read(MAX_BYTES + 1)
    if len(data) > MAX_BYTES:
        raise ConvertError(f"{path}: more than {MAX_BYTES} bytes")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise ConvertError(f"{path}: no UTF-8 at byte {error.start}") from None
    # Tokens may hold any other character that ends a line elsewhere.
    lines = text.removesuffix("\n").split("\n") if text else []
    return [line.removesuffix("\r") for line in lines]
