"""What models/text must give, derived from the rules with nothing but Python's own Unicode.

Writes three files beside this script; their first line names the Unicode version of unicodedata:
wordpiece_vocab.txt     a small vocabulary, made for these cases
wordpiece_cases.tsv     name, lower or cased, text in hexadecimal, tokens as id:begin:end
wordpiece_unicode.tsv   C first last kind role mark class: runs of code points with equal properties
                        D code_point images: lower case, then canonically decomposed, where it differs

usage: wordpiece_expectations.py           write them
       wordpiece_expectations.py --check   fail when they differ from what would be written
"""
import itertools
import pathlib
import random
import sys
import unicodedata

FOLDER = pathlib.Path(__file__).resolve().parent
VERSION = f"# Unicode {unicodedata.unidata_version}, written by {pathlib.Path(__file__).name}\n"
MAX_WORD_CHARS = 100
SPECIAL = ["[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]"]
IDEOGRAPHS = ((0x4E00, 0x9FFF), (0x3400, 0x4DBF), (0x20000, 0x2A6DF), (0x2A700, 0x2B73F),
              (0x2B740, 0x2B81F), (0x2B820, 0x2CEAF), (0xF900, 0xFAFF), (0x2F800, 0x2FA1F))
HANGUL = range(0xAC00, 0xD7A4)

# In the vocabulary besides single characters: longest match, pieces inside pieces, dead ends.
PIECES = ["un", "una", "##aff", "##affable", "##ffab", "##able", "able", "deep", "learn", "##ing",
          "##in", "straße", "##ße", "##σ", "οδυσσευς", "##ευς", "ca", "##a7", "don", "##'", "2023",
          "##23", "naive", "##ive", "के", "##लिए", "日本", "a" * 99, "##" + "a" * 98, "[CLS"]
# Not in the vocabulary: words that need them are [UNK].
MISSING = {"☃", "##7", "q", "##q", "##ж", "\U0001f99a"}

TEXTS = {
    "empty": "",
    "spaces": " \t\n\r\u00a0\u3000\u2003 ",
    "line_separators": "deep\u2028learning\u2029un\x0bable\x0cun\x1cable\x85un",
    "english": "Deep learning, isn't it? Don't say \u201cUNAFFABLE\u201d -- he said (twice).",
    "longest_match": "unaffable unaff unable una uun able",
    "dead_end": "ca7 c7 a7 ca 7 quit ж жж ☃ a☃ ☃a",
    "special_tokens": "[CLS] deep [SEP] [MASK] [UNK][PAD] [cls]",
    "hashes": "##ing # ## un##able",
    "french": "Où êtes-vous, garçon ? L\u2019été à Nîmes\u00a0: «\u202fÇa va\u202f» œuf Œuvre",
    "french_decomposed": unicodedata.normalize("NFD", "Où êtes-vous, garçon naïve à Nîmes"),
    "german": "Straße STRASSE STRAẞE Äpfel Übermut größte",
    "turkish": "İstanbul Iğdır ISPARTA ılık DİYARBAKIR i̇",
    "greek": "ΟΔΥΣΣΕΥΣ Ὀδυσσεύς ΆΣΟΣ ΣΑΣ Σ ΑΣ. ΑΣ.Β Σ.Α ΑΣ'",
    "final_sigma_marks": "ΑΣ\u0301 ΑΣ\u0301Β Α\u0301Σ Α\u00adΣ Α-Σ 1Σ ΑΣ1 ΑΣ\u00adΒ "
                         "ΑΣ:Β ΑΣ,Β \u02b0Σ ªΣ ⅠΣ ⒶΣ \u0345Σ",
    "final_sigma_ideograph": "ΑΣ中Σ中ΑΣΣ",
    "final_sigma_runs": "ΑΣ''''Σ''''ΣΑ Α''''Σ ΑΣ....  ΑΣ....Β",
    "cyrillic": "Привет, Мир! Ёлка й ЙОД ж",
    "arabic": "السَّلامُ عَلَيْكُمْ، كيف حالك؟ أإآ",
    "hebrew": "שָׁלוֹם עוֹלָם־טוב״",
    "hindi": "नमस्ते दुनिया। के लिए क़ ऩ",
    "thai": "สวัสดีชาวโลก ที่นี่",
    "chinese": "我爱deep学习，OK吗？\U00020000\u3400\uf900\U0002f800",
    "japanese": "日本語とカタカナ、ガｶﾞ「深層」learning",
    "korean": "한국어 각 deep러닝 가\u11a8",
    "emoji": "ok 👩\u200d👩\u200d👧 👍🏽 🇫🇷 ❤\ufe0f \U0001f99a 1\ufe0f\u20e3",
    "marks_alone": "\u0301 \u0301\u0302 a\u0301\u0302\u0323b \u0488",
    "marks_reordered": "가\u302f\u0323\u302e ᮢ\u1baa\u302e\u0301 \U0001d15f\u302e\U0001d165b",
    "marks_and_barriers": "a\u302e\u0941\U0001d165 a\u302e\u0334\U0001d165\u0301x",
    "decomposes_to_sign": "a≠b ≮ ≯x \u1fef \u037e \u0387 \u1fee",
    "ligatures": "ﬁn ﬀ ﬃ ĳ Ǆ ǅ ŉ",
    "full_width": "ＡＢＣ，ａｂｃ　１２３！",
    "singletons": "\u2126 \u212a \u212b \u2160\u2170 \u24b6",
    "controls": "de\u0000ep\u0001 l\u007fe\u0080arn\u200bing "
                "\ufeffun\u00adable\ue000 \ufffdx\U000e0001 \U0010ffff",
    "bom": "\ufeffDeep",
    "whitespace_inside": "un\u00a0able\u2009deep\u202flearn\u205fing\u1680x\u200ay",
    "signs": "$1,000.00 + 5% = x^2 ~ `a` |b| <c> €5 £6 ©7 a_b",
    "quotes_and_dashes": "\u201c\u2018a\u2019 \u2014 b\u201d\u2013\u2012c\u2026 "
                         "\u00abd\u00bb '\"e\"' \u2010\u2011 \u2e3a",
    "digits": "2023 20232 ١٢٣ ²³ ½ 3.14",
    "word_of_99": "a" * 99,
    "word_of_100": "a" * 100,
    "word_of_101": "a" * 101,
    "word_of_100_accents": "a\u0301" * 100,
    "word_of_101_accents": "á" * 101,
    "word_of_101_then_more": "b" * 101 + ".deep " + "b" * 100 + ",",
    "word_of_51_syllables": "가" * 50 + " " + "가" * 51,
    "long_marks": "a" + "\u302e" * 99 + " b" + "\u302f\U0001d165" * 80 + "c. d",
    "punctuation_run": "!?" * 150,
    "truncated": b"deep \xf0\x9f\x91 \xe4\xb8un\xc3",
    "bad_bytes": b"\xff\xfede\xc0\x80ep \x80\xed\xa0\x80able "
                 b"\xf4\x90\x80\x80. \xe2\x28\xa1 \xf8\x88\x80\x80\x80x",
    "bad_byte_in_sigma": "ΑΣ".encode() + b"\xff" + "Α ΑΣ".encode() + b"\xff",
}
# What random texts are made of: each of these has tripped some tokeniser.
POOL = list("aAzZ019 .,'’-#Σσςß\t\nİıÉéñΆΐ中日한가글カガﬁ＃₂ªⅠⒶ👍") + [
    "\u0000", "\u00a0", "\u00ad", "\u0301", "\u0323", "\u0345", "\u0488", "\u0941", "\u094d", "\u11a8",
    "\u1100", "\u1161", "\u1fef", "\u200d", "\u2028", "\u2260", "\u302e", "\u302f", "\u3000", "\ufe0f",
    "\ufffd", "\uf900", "\U0001d15f", "\U0001d165", "\U0001d16d", "\U00020000", "\U000f0000"]


def kind_of(char):
    category = unicodedata.category(char)
    if char in "\t\n\r":
        return "space"
    if char in "\0\ufffd" or category[0] == "C":
        return "dropped"
    if category == "Zs" or char.isspace():
        return "space"
    if any(first <= ord(char) <= last for first, last in IDEOGRAPHS):
        return "ideograph"
    if category[0] == "P" or (" " < char < "\x7f" and not char.isalnum()):
        return "punctuation"
    return "other"


def placed(text):
    """(character, begin, end) of the bytes; each byte that is not UTF-8 becomes a surrogate (Cs)."""
    at = 0
    for char in text.decode("utf-8", "surrogateescape"):
        size = len(char.encode("utf-8", "surrogateescape"))
        yield char, at, at + size
        at += size


def runs_of(text):
    """What is between white space, an ideograph by itself, dropped characters gone."""
    run = []
    for char, begin, end in placed(text):
        kind = kind_of(char)
        if kind in ("space", "ideograph"):
            yield run
            run = []
        if kind == "ideograph":
            yield [(char, begin, end)]
        elif kind in ("punctuation", "other"):
            run.append((char, begin, end))
    yield run


def lowered(run):
    text = "".join(char for char, _, _ in run)
    result = []
    lower = iter(text.lower())  # as a whole, for the final sigma
    for char, begin, end in run:
        result += [(c, begin, end) for c in itertools.islice(lower, len(char.lower()))]
    assert "".join(c for c, _, _ in result) == text.lower()
    return result


def decomposed(run):
    """NFD without Mn.  Characters that canonical order may exchange share the bytes of all."""
    flat = [(part, begin, end) for char, begin, end in run
            for part in unicodedata.normalize("NFD", char)]
    result, whole = [], []
    for moves, group in itertools.groupby(flat, lambda c: unicodedata.combining(c[0]) != 0):
        group = list(group)
        if moves:
            group.sort(key=lambda c: unicodedata.combining(c[0]))
        whole += group
        kept = [c for c in group if unicodedata.category(c[0]) != "Mn"]
        if moves and kept:
            begin, end = min(c[1] for c in kept), max(c[2] for c in kept)
            kept = [(c, begin, end) for c, _, _ in kept]
        result += kept
    text = "".join(char for char, _, _ in run)
    assert "".join(c for c, _, _ in whole) == unicodedata.normalize("NFD", text)
    return result


def words_of(text, lower):
    for run in runs_of(text):
        if lower:
            run = decomposed(lowered(run))
        # Every punctuation character is a group of its own, by its place.
        alone = [i if kind_of(c[0]) == "punctuation" else -1 for i, c in enumerate(run)]
        for _, word in itertools.groupby(range(len(run)), lambda i: alone[i]):
            yield [run[i] for i in word]


def pieces_of(word, ids):
    unknown = [(ids["[UNK]"], word[0][1], word[-1][2])]
    if len(word) > MAX_WORD_CHARS:
        return unknown
    pieces, start = [], 0
    while start < len(word):
        for end in range(len(word), start, -1):
            piece = ("##" if start else "") + "".join(c for c, _, _ in word[start:end])
            if piece in ids:
                break
        else:
            return unknown
        pieces.append((ids[piece], word[start][1], word[end - 1][2]))
        start = end
    return pieces


def tokens_of(text, lower, ids):
    return [piece for word in words_of(text, lower) for piece in pieces_of(word, ids)]


def texts():
    for name, text in TEXTS.items():
        yield name, text if isinstance(text, bytes) else text.encode("utf-8")
    dice = random.Random(20190524)
    for i in range(150):
        text = "".join(dice.choice(POOL) for _ in range(dice.randrange(1, 24))).encode("utf-8")
        yield f"random_{i}", text[:len(text) - dice.randrange(2)]


def vocabulary():
    characters = sorted({char for _, text in texts() for lower in (True, False)
                         for word in words_of(text, lower) for char, _, _ in word})
    singles = [prefix + char for prefix in ("", "##") for char in characters]
    return SPECIAL + list(dict.fromkeys(t for t in singles + PIECES if t not in MISSING))


def cases(tokens):
    ids = {token: i for i, token in enumerate(tokens)}
    yield VERSION
    for name, text in texts():
        for lower in (True, False):
            found = " ".join(f"{i}:{begin}:{end}" for i, begin, end in tokens_of(text, lower, ids))
            yield f"{name}\t{'lower' if lower else 'cased'}\t{text.hex()}\t{found}\n"


def role_of(char):
    """What str.lower() shows: does a sigma become final after the character, and through it?"""
    after = (char + "Σ").lower()[-1] == "ς"
    through = ("a" + char + "Σ").lower()[-1] == "ς"
    return "cased" if after else "ignorable" if through else "none"


def properties(code):
    char = chr(code)
    category = unicodedata.category(char)
    if category in ("Cn", "Cs"):  # a later Unicode may have assigned it; no UTF-8
        return None
    return (f"{kind_of(char)}\t{role_of(char)}\t{int(category == 'Mn')}\t"
            f"{unicodedata.combining(char)}")


def unicode_lines():
    yield VERSION
    for found, run in itertools.groupby(range(0x110000), properties):
        run = list(run)
        if found:
            yield f"C\t{run[0]:x}\t{run[-1]:x}\t{found}\n"
    for code in range(0x110000):
        char = chr(code)
        # U+0130 also becomes a dot above, which is dropped like every accent.
        lower = "i" if char == "İ" else char.lower()
        images = unicodedata.normalize("NFD", lower)
        if images != char and code not in HANGUL:  # those follow a formula
            yield f"D\t{code:x}\t{' '.join(f'{ord(c):x}' for c in images)}\n"


def files():
    tokens = vocabulary()
    yield "wordpiece_vocab.txt", "".join(token + "\n" for token in tokens)
    yield "wordpiece_cases.tsv", "".join(cases(tokens))
    yield "wordpiece_unicode.tsv", "".join(unicode_lines())


def main():
    for name, content in files():
        path, content = FOLDER / name, content.encode("utf-8")
        if sys.argv[1:] != ["--check"]:
            path.write_bytes(content)
        elif path.read_bytes() != content:
            sys.exit(f"{path} is not what this script writes with Unicode "
                     f"{unicodedata.unidata_version}")


if __name__ == "__main__":
    main()
