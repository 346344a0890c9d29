"""What is said: monologues of some sentences, and which split a sentence belongs to.

A sentence belongs to one split for ever, by the digest of its text, so no seed, speaker or size of
a corpus can bring a held-out sentence into training.
"""

import dataclasses

from . import grammar, lexicon

SHARES = (("train", 0.70), ("dev", 0.08), ("test", 0.11), ("unseen", 0.11))

# How often an act occurs in a monologue, after its opening and before its closing.
_BODY = {
    "Statement-non-opinion": 24, "Statement-opinion": 17, "Yes-No-Question": 10, "Wh-Question": 10,
    "Action-directive": 9, "Negative non-no answers": 6, "Appreciation": 6, "Thanking": 5,
    "Apology": 5, "Agree/Accept": 4, "Maybe/Accept-part": 4, "Hedge": 4,
    "Offers, Options Commits": 4, "Rhetorical-Questions": 4, "Open-Question": 3, "Tag-Question": 3,
    "Summarize/reformulate": 3, "Or-Clause": 2, "Declarative Yes-No-Question": 2, "Quotation": 2,
}
_ACTS = tuple(_BODY)
_WEIGHTS = tuple(n / sum(_BODY.values()) for n in _BODY.values())


@dataclasses.dataclass(frozen=True)
class Sentence:
    act: str
    words: tuple  # of (word with its punctuation, emphasis)

    @property
    def text(self):
        return grammar.plain(self.words)


def split_of(text):
    at = lexicon.fraction("split " + text.lower())
    for name, share in SHARES:
        at -= share
        if at < 0:
            return name
    return SHARES[-1][0]


def draw(act, split, rng):
    """A Sentence of that act and split, or None where there seems to be none."""
    for _ in range(200):
        words = tuple(grammar.sentence(act, rng))
        if split_of(grammar.plain(words)) == split:
            return Sentence(act, words)
    return None


def monologue(split, rng, words=40):
    """[Sentence] of some `words` words in all."""
    found, spoken = [], 0
    if rng.random() < 0.35:
        found.append(draw("Conventional-opening", split, rng))
    while spoken < words:
        found.append(draw(str(rng.choice(_ACTS, p=_WEIGHTS)), split, rng))
        found = [sentence for sentence in found if sentence is not None]
        spoken = sum(len(sentence.words) for sentence in found)
    if rng.random() < 0.25:
        found.append(draw("Conventional-closing", split, rng))
    return [sentence for sentence in found if sentence is not None]


def sample(count, rng):
    """[(split, Sentence)] for networks that learn the language: half by how often acts are spoken,
    half with every act of DialogTag equally often.  No text twice."""
    found = {}
    acts = tuple(grammar.TEMPLATES)
    for n in range(4 * count):
        act = str(rng.choice(_ACTS, p=_WEIGHTS)) if n % 2 else acts[rng.integers(len(acts))]
        words = tuple(grammar.sentence(act, rng))
        text = grammar.plain(words)
        found.setdefault(text, (split_of(text), Sentence(act, words)))
        if len(found) == count:
            break
    return list(found.values())


def write_tsv(path, sentences):
    """id, split, act, sentence; `sentences`: [(split, Sentence)]"""
    lines = ["id\tsplit\tact\tsentence"]
    lines += [f"{n}\t{split}\t{sentence.act}\t{sentence.text}"
              for n, (split, sentence) in enumerate(sentences)]
    path.write_text("\n".join(lines) + "\n")
