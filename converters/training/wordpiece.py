"""A WordPiece vocabulary from texts, and texts in its pieces, as the engine's tokeniser has them
(models/text/wordpiece.h) for languages written in letters with spaces between words."""

import collections
import string
import unicodedata

SPECIAL = ("[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]")
PAD, UNK, CLS, SEP, MASK = range(len(SPECIAL))
_INNER = "##"


def words_of(text):
    """Lower case, no accents, every punctuation character a word of its own."""
    plain = "".join(c for c in unicodedata.normalize("NFD", text.lower())
                    if unicodedata.category(c) != "Mn")
    spaced = "".join(f" {c} " if _is_punctuation(c) else c for c in plain)
    return spaced.split()


def stripped(text):
    """The words of `text` without punctuation at their ends: what the engine makes features of."""
    found = (word.strip(string.punctuation + "“”‘’…–—") for word in text.split())
    return [word for word in found if word]


def _is_punctuation(c):
    return c in string.punctuation or unicodedata.category(c).startswith("P")


def learn(texts, size):
    """Tokens of a vocabulary of at most `size`: letters and digits at either place, punctuation, then
    the pair of neighbouring pieces that occurs most, again and again (Sennrich et al. 2016)."""
    counts = collections.Counter(word for text in texts for word in words_of(text))
    letters = sorted({c for word in counts for c in word} | set(string.ascii_lowercase)
                     | set(string.digits) | set(string.punctuation))
    tokens = [*SPECIAL, *letters,
              *(_INNER + c for c in letters if not _is_punctuation(c))]
    known = set(tokens)
    pieces = {word: [c if n == 0 else _INNER + c for n, c in enumerate(word)] for word in counts}
    while len(tokens) < size:
        pairs = collections.Counter()
        for word, parts in pieces.items():
            for pair in zip(parts, parts[1:]):
                pairs[pair] += counts[word]
        if not pairs:
            break
        pair, count = max(pairs.items(), key=lambda item: (item[1], item[0]))
        if count < 2:
            break
        joined = pair[0] + pair[1].removeprefix(_INNER)
        for word, parts in pieces.items():
            pieces[word] = _merged(parts, pair, joined)
        if joined not in known:
            known.add(joined)
            tokens.append(joined)
    return tokens


def _merged(parts, pair, joined):
    found, at = [], 0
    while at < len(parts):
        if tuple(parts[at:at + 2]) == pair:
            found.append(joined)
            at += 2
        else:
            found.append(parts[at])
            at += 1
    return found


class WordPiece:
    def __init__(self, tokens):
        self.tokens = tokens
        self._ids = {token: n for n, token in enumerate(tokens)}

    def encode(self, text):
        """Ids of the pieces of a text, without [CLS] and [SEP]."""
        return [piece for word in words_of(text) for piece in self._word(word)]

    def _word(self, word):
        found, at = [], 0
        while at < len(word):
            begin = "" if at == 0 else _INNER
            ends = (end for end in range(len(word), at, -1) if begin + word[at:end] in self._ids)
            end = next(ends, None)
            if end is None:
                return [UNK]
            found.append(self._ids[begin + word[at:end]])
            at = end
        return found
