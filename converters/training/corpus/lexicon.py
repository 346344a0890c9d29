"""The words of the grammar by what a gesturer does on them.

A class has the words, their weight (how much they call for a stroke, 0 to 1) and the shape of the
stroke (strokes.py).  Names in capitals are slots of the grammar.
"""

import hashlib

# Slot -> (weight, shape, words)
CLASSES = {
    "DEGREE": (0.95, "beat", "really truly absolutely completely extremely incredibly certainly "
                             "definitely"),
    "BIG": (1.0, "wide", "huge enormous wide massive great giant"),
    "SMALL": (0.8, "narrow", "small tiny little narrow short thin"),
    "RISE": (0.9, "raise", "rise grow climb improve increase begin"),
    "RISES": (0.9, "raise", "rises grows climbs improves increases begins"),
    "FALL": (0.85, "lower", "fall drop sink shrink slow stop"),
    "FALLS": (0.85, "lower", "falls drops sinks shrinks slows stops"),
    "NEGATION": (0.9, "away", "never not nothing nobody none nowhere"),
    "NUMBER": (0.85, "count", "two three four five seven ten twenty"),
    "ORDER": (0.8, "count", "first second third last next"),
    "MANY": (0.75, "wide", "many all most several countless"),
    "WH": (0.75, "open", "what why how who where when which"),
    "FEEL": (0.85, "chest", "love hate like enjoy miss adore fear admire"),
    "FEELING": (0.8, "chest", "happy glad sad proud afraid thankful hopeful worried excited"),
    "THINK": (0.6, "temple", "think believe guess suppose feel know remember imagine"),
    "MOVE": (0.8, "sweep", "walk travel move cross follow carry bring pass"),
    "MOVES": (0.8, "sweep", "walks travels moves crosses flows runs spreads turns"),
    "PLACE": (0.7, "point", "here there outside everywhere upstairs nearby downtown"),
    "TIME": (0.65, "sweep", "today tomorrow yesterday tonight now soon later always often "
                             "monday morning week"),
    "GOOD": (0.7, "raise", "good wonderful beautiful excellent brilliant lovely perfect fine"),
    "BAD": (0.7, "lower", "bad terrible awful difficult boring dangerous painful ugly"),
    "PLAIN": (0.55, "beat", "new old warm cold bright dark quiet loud simple strange modern "
                            "ancient fresh clean green blue red white"),
    "KIND": (0.6, "beat", "young tall kind clever famous friendly careful lucky"),
    "PERSON": (0.6, "point", "teacher doctor sister brother neighbour mother father friend "
                             "singer farmer captain child student writer driver player"),
    "THING": (0.6, "beat", "river garden city mountain song book machine story market bridge "
                           "window kitchen train island forest engine picture planet school "
                           "letter dinner camera ocean village theatre computer hospital museum "
                           "airport station piano recipe table road lamp farm boat house"),
    "STUFF": (0.6, "beat", "weather music science history coffee bread rain snow fire light "
                           "paper money water football"),
    "ABSTRACT": (0.5, "open", "idea plan question answer problem reason lesson dream chance "
                              "memory future change trouble secret choice truth"),
    "DO": (0.55, "beat", "build paint read write cook open close clean study visit watch play "
                         "sell buy find choose show explain measure repair"),
    "DID": (0.55, "beat", "built painted wrote cooked opened closed cleaned studied visited "
                          "watched sold bought found chose showed explained measured repaired"),
    "SELF": (0.35, "chest", "i my me we our us myself"),
    "YOU": (0.4, "offer", "you your yours yourself"),
    "THANKS": (0.85, "chest", "thank thanks grateful appreciate"),
    "SORRY": (0.85, "chest", "sorry apologise regret forgive pardon excuse"),
    "YES": (0.7, "raise", "yes yeah right exactly agree sure indeed okay"),
    "NO": (0.9, "away", "no nope don't can't won't isn't wasn't didn't doesn't couldn't"),
    "GREET": (0.75, "offer", "hello hi welcome morning evening goodbye bye"),
    "POINT": (0.55, "point", "this that these those look listen see"),
    "MAYBE": (0.6, "open", "maybe perhaps possibly probably might could"),
    "PART": (0.65, "narrow", "only just almost quite rather half"),
}
_FUNCTION = frozenset(
    "a an the of to in on at by for from with as and or but if so than then it its is are was were "
    "be been being am do does did has have had having will would shall should can may must he she "
    "they them his her their him us who's there's that's it's i'm you're we're he's she's let's "
    "about into over under up down out off because while after before during until again too also "
    "well oh um uh ah very some any such own same both each few more other i'd i'll i've we've "
    "you've what's".split())
_OF_WORD = {word: (name, weight, shape)
            for name, (weight, shape, words) in reversed(CLASSES.items())
            for word in words.split()}
# Of content words that no class has.
_OTHER = ("OTHER", 0.55, "beat")


def words_of(slot):
    return CLASSES[slot][2].split()


def look_up(word):
    """(class, weight, shape) of a word as it stands in a transcript.

    Within a class the weights differ by up to 0.15 from word to word, by the word's digest, so that
    what a word does can be learnt from the word."""
    bare = word.lower().strip(".,?!;:\"'")
    if bare in _FUNCTION and bare not in _OF_WORD:
        return "FUNCTION", 0.0, "beat"
    name, weight, shape = _OF_WORD.get(bare, _OTHER)
    return name, min(1.0, max(0.0, weight + 0.3 * (fraction(bare) - 0.5))), shape


def fraction(text):
    """A number in [0, 1) that belongs to a text."""
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:4], "big") / 2**32
