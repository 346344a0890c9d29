"""Sentences with a known dialog act, drawn from templates by seed.

A template is words; {SLOT} stands for a word of that class (lexicon.py), {a|b|} for one of several
texts, and * before a word for emphasis.  Acts are DialogTag's (converters/kinds/bert.py).
"""

import re

from . import lexicon

_SLOTS = {
    "SUBJECT": "{the|my|our|this|that|the {PLAIN}}",
    "WHO": "{the {PERSON}|my {PERSON}|our {PERSON}|the {KIND} {PERSON}}",
    "ONE": "{the {THING}|a {PLAIN} {THING}|the {BIG} {THING}|a {SMALL} {THING}|my {THING}|"
           "the {PLAIN} {THING}|our {BIG} {THING}|{PLAIN} {STUFF}|the {STUFF}}",
    "WHAT": "{{ONE}|{ONE}|{ONE}|{NUMBER} {PLAIN} {THING}s|{MANY} {THING}s}",
    "WHERE": "{near the {THING}|behind the {THING}|{PLACE}|in the {THING}|"
             "beside the {PLAIN} {THING}|}",
    "WHEN": "{today|tonight|on Monday|in the morning|after dinner|every week|at night|}",
    "PAST": "{yesterday|last year|on Monday|this morning|after dinner|}",
}

# act -> templates.
TEMPLATES = {
    "Statement-non-opinion": (
        "{WHO} {DID} {WHAT} {WHERE} {PAST}.",
        "{WHO} and {WHO} {DID} {WHAT} {PAST}.",
        "{SUBJECT} {THING} {MOVES} {WHERE} and *never {FALLS}.",
        "There are {NUMBER} {THING}s {WHERE}, and {WHO} {DID} *all of them.",
        "I {DID} {WHAT}, and then I {DID} {WHAT}.",
        "We {MOVE} across {WHAT} and *look at {WHAT}.",
        "When {SUBJECT} {THING} {RISES}, {WHO} must {DO} {WHAT}.",
        "{SUBJECT} {PERSON} has a {PLAIN} {ABSTRACT} about {WHAT}.",
        "{Today|Tomorrow|Tonight|Soon}, {WHO} will {DO} {WHAT} {WHERE}.",
        "The {ORDER} {THING} is {PLAIN}, the {ORDER} one is {PLAIN}.",
        "My {PERSON} {DID} {WHAT} {WHERE}, but the {PERSON} did *not {DO} it.",
        "It was a {PLAIN} {THING}, and {MANY} {THING}s were {PLAIN}.",
    ),
    "Statement-opinion": (
        "I {THINK} {SUBJECT} {THING} is {DEGREE} {GOOD}.",
        "I {THINK} that {WHO} {DID} a {*|}{GOOD} {THING} {PAST}.",
        "{SUBJECT} {THING} is *{DEGREE} {BAD}, and {WHO} should {DO} it.",
        "We should {*|}{DO} {WHAT}, because the {ABSTRACT} is {BIG}.",
        "In my opinion, {ONE} is {PART} {BAD}.",
        "I {FEEL} {WHAT}, and I {FEEL} {WHAT} {*|}{DEGREE}.",
        "It is {GOOD} to {DO} {WHAT} {WHEN}.",
        "{MANY} {THING}s are {BAD}, but {SUBJECT} {THING} is *{GOOD}.",
        "{SUBJECT} {ABSTRACT} is {BIG}, and the {ABSTRACT} is {SMALL}.",
        "For me, {ONE} is {GOOD}, and that is a {BIG} {ABSTRACT}.",
    ),
    "Yes-No-Question": (
        "{Do|Did|Can|Will|Would} you {DO} {WHAT} {WHERE}?",
        "Is {SUBJECT} {THING} {*|}{GOOD}?",
        "Did {WHO} {DO} {WHAT} {WHEN}?",
        "Have you {*ever|} seen {WHAT} {WHERE}?",
        "Are you {FEELING} about {WHAT}?",
        "Can we {DO} {WHAT} {WHEN}?",
        "Does {WHO} {FEEL} {WHAT}?",
        "Was it {WHO} who {DID} {WHAT}?",
    ),
    "Wh-Question": (
        "*What did {WHO} {DO} {WHERE}?",
        "*Why did you {DO} {WHAT}?",
        "*Where is {ONE}?",
        "*How can we {DO} {WHAT} {WHEN}?",
        "*Who {DID} {WHAT} {WHERE}?",
        "*When will {WHO} {DO} {WHAT}?",
        "*Which {THING} do you {FEEL}?",
        "How *many {THING}s did {WHO} {DO}?",
    ),
    "Open-Question": (
        "How do you {feel|think} about {WHAT}?",
        "What do *you {think|know} of {WHAT}?",
        "What about {WHAT} {WHERE}?",
        "How was {ONE} {WHEN}?",
    ),
    "Rhetorical-Questions": (
        "Who would *not {FEEL} {WHAT}?",
        "How could {anyone|anybody} {DO} {WHAT}?",
        "Who knows *why {SUBJECT} {THING} {FALLS}?",
        "Why should *anybody {DO} {WHAT}?",
    ),
    "Or-Clause": (
        "Or do you {DO} {WHAT}?", "Or is it {PLAIN}, like {WHAT}?", "Or was it {WHO}?",
        "Or {would|will} {WHO} {DO} {WHAT}?",
    ),
    "Tag-Question": (
        "It is {GOOD}, *isn't it?", "{SUBJECT} {THING} is {BAD}, isn't it?",
        "{WHO} {DID} {WHAT}, didn't they?", "You {FEEL} {WHAT}, don't you?",
    ),
    "Declarative Yes-No-Question": (
        "So {WHO} {DID} {WHAT}?", "You {DID} {WHAT} {WHERE}?", "So you {FEEL} {WHAT}?",
        "So {SUBJECT} {THING} is {PLAIN}?",
    ),
    "Declarative Wh-Question": (
        "You {DID} *what?", "{WHO} went *where?", "You {DID} {WHAT} *when?",
        "They {DID} {WHAT} with *whom?",
    ),
    "Backchannel in question form": (
        "{Really|Is that so|Is that right|You did|Did they}?", "Oh, {really|did you|is it}?",
        "Is that so, {WHEN}?",
    ),
    "Action-directive": (
        "*Look at {WHAT} {WHERE}.",
        "Please {DO} {WHAT} {WHEN}.",
        "*{DO} {WHAT}, and then {DO} {WHAT}.",
        "Let us {DO} {WHAT} {WHERE}.",
        "{Do not|Don't} {DO} {WHAT} {WHERE}.",
        "Listen to {WHAT}, and {MOVE} {PLACE}.",
        "*Stop, and {think|dream} of {WHAT}.",
        "Take {WHAT}, and {MOVE} it {PLACE}.",
    ),
    "Offers, Options Commits": (
        "I will {DO} {WHAT} for you.", "I can {DO} {WHAT} {WHEN}, if you {FEEL} it.",
        "Let me {DO} {WHAT} for {WHO}.", "We could {DO} {WHAT}, or {DO} {WHAT}.",
    ),
    "Thanking": (
        "*Thank you for {WHAT}.", "*Thanks, {WHO} {DID} it {DEGREE} well.",
        "Thank you {so|very} much for {WHAT}.", "I am {DEGREE} *grateful for {WHAT}.",
        "Thanks a lot for the {GOOD} {THING}.", "Thank you all for {the|this} {THING} {WHEN}.",
    ),
    "Apology": (
        "I am *{DEGREE} sorry about {WHAT}.", "I am sorry that {WHO} {DID} {WHAT}.",
        "*Sorry, I did *not {DO} {WHAT}.", "I apologise for {WHAT} {WHERE}.",
        "Please forgive me for {WHAT}.", "Excuse me, I {DID} {WHAT}.",
    ),
    "Agree/Accept": (
        "*Yes, {WHO} is {DEGREE} right about {WHAT}.", "That is {DEGREE} *true of {WHAT}.",
        "*Exactly, {ONE} is {GOOD}.", "I agree with you about {WHAT}.",
        "You are right, {SUBJECT} {THING} {RISES}.",
    ),
    "Maybe/Accept-part": (
        "Maybe {WHO} {DID} {WHAT}.", "Perhaps it is {PLAIN}, like {WHAT}.",
        "It might be {BAD}, {but|and} {ONE} is {GOOD}.", "Possibly {SUBJECT} {THING} {RISES}.",
    ),
    "Appreciation": (
        "What a *{GOOD} {THING}!", "That is *{DEGREE} {GOOD}!", "{SUBJECT} {THING} is *{GOOD}!",
        "How {GOOD} {the|this} {THING} is {WHEN}!", "I {FEEL} {WHAT} *{DEGREE}!",
    ),
    "Conventional-opening": (
        "*Hello, and welcome to {SUBJECT} {THING}.",
        "Good {morning|evening}, {I am|we are} {in the {THING}|near the {THING}|{PLACE}}.",
        "Hi, I am {the|your} {PERSON} of the {THING}.", "*Welcome, {this|that} is {WHAT}.",
        "Good {morning|evening}, how are you {WHEN}?",
    ),
    "Conventional-closing": (
        "*Goodbye, and {DO} {WHAT}.", "See you {WHEN}, near {the|my} {THING}.",
        "It was {GOOD} to talk about {WHAT}, bye.", "Good night, and have a {GOOD} {THING}.",
        "That is all about {WHAT}, *goodbye.",
    ),
    "No answers": ("*No.", "No, {never|nothing|not at all}.", "*No, {WHO} did *not."),
    "Yes answers": ("*Yes.", "Yes, {WHO} did.", "Yeah, {always|often|now|{PLACE}}.",
                    "Yes, {DEGREE}."),
    "Negative non-no answers": (
        "{WHO} did *not {DO} {WHAT}.", "*Not {DEGREE}, I {DID} {WHAT}.", "I don't {DO} {WHAT}.",
        "We *never {DO} {WHAT} {WHEN}.", "It isn't {GOOD} to {DO} {WHAT}.",
    ),
    "Affirmative non-yes answers": (
        "I do, I {DO} it {PAST}.", "It is, {WHO} {DID} it.", "They did, and {WHO} did {PAST}.",
    ),
    "Dispreferred answers": (
        "Well, *not {PAST}, I {DID} {WHAT}.", "Well, {WHO} is {PART} {BAD}, you know.",
    ),
    "Hedge": (
        "I don't know if {WHO} {DID} {WHAT}.", "I am not sure about {WHAT}, I guess.",
        "I am only {PART} sure, but {ONE} is {PLAIN}.", "Well, I could be wrong about {WHAT}.",
    ),
    "Downplayer": (
        "That is all right, it is {PART} {WHAT}.", "It was nothing, {PART} {WHAT}.",
        "Don't worry about {WHAT}.",
    ),
    "Summarize/reformulate": (
        "So {WHO} {DID} {WHAT}, in short.", "In other words, {ONE} is {PLAIN}.",
        "So what you mean is that {SUBJECT} {THING} {RISES}.",
    ),
    "Quotation": (
        "And {WHO} said, I {DID} {WHAT}.", "He said, please {DO} {WHAT}.",
        "And then she asked, is it {PLAIN}.",
    ),
    "Repeat-phrase": ("Oh, {WHAT}.", "{NUMBER} {THING}s, {NUMBER} {THING}s.", "A {PLAIN} {THING}."),
    "Self-talk": ("What was {the|that} {THING} called, let me see.", "Now where did I put {WHAT}.",
                  "What is the word for {WHAT}, let me think."),
    "3rd-party-talk": ("{WHO}, {DO} {the|that} {THING}, I am talking.",
                       "Hey, {PERSON}, come {PLACE}.",
                       "Just a moment, {PERSON}, I am on the phone."),
    "Signal-non-understanding": ("Sorry, what was {WHAT}?", "Excuse me, I did not hear {WHAT}?",
                                 "What did you say about {WHAT}?"),
    "Hold before answer/agreement": ("Let me think about {WHAT}.", "Well, let me see, {WHAT}.",
                                     "I am trying to remember {WHAT}."),
    "Collaborative Completion": ("And {DO} {WHAT}.", "Or {the|a} {PLAIN} {THING}.",
                                 "With {WHO}."),
    "Acknowledge (Backchannel)": ("Uh-huh.", "Mm, {yeah|right|sure}.", "Yeah, {the|that} {THING}.",
                                  "Right, {right|uh-huh|okay}."),
    "Response Acknowledgement": ("Oh, okay.", "Oh, I see, {WHAT}.", "All right, {TIME}.",
                                 "Okay, {the|a} {PLAIN} {THING}."),
    "Other": ("So, {anyway|and|but}.", "Well, {you know|I mean}, {TIME}.", "And, so, {WHEN}."),
}

_CHOICE = re.compile(r"\{([^{}]*)\}")


def sentence(act, rng):
    """[(word with its punctuation, emphasis)] of a sentence with that act."""
    templates = TEMPLATES[act]
    text = templates[rng.integers(len(templates))]
    for _ in range(100):
        # From the inside out: a slot within a choice first.
        text, changed = _CHOICE.subn(lambda found: _fill(found.group(1), rng), text)
        if not changed:
            break
    return _words(text)


def plain(words):
    """The sentence as it is written."""
    return " ".join(word for word, _ in words)


def _fill(inside, rng):
    if inside in _SLOTS:
        return _SLOTS[inside]
    if inside in lexicon.CLASSES:
        words = lexicon.words_of(inside)
        return words[rng.integers(len(words))]
    choices = inside.split("|")
    return choices[rng.integers(len(choices))]


def _words(text):
    text = re.sub(r"\s+([.,?!])", r"\1", re.sub(r"\s+", " ", text)).strip()
    text = re.sub(r"([^aeiou])ys\b", r"\1ies", text)
    text = re.sub(r"\b([aA]) (?=\*?[aeiou])", r"\1n ", text)
    found = []
    for word in text.split(" "):
        found.append((word.lstrip("*"), word.startswith("*")))
    first, emphasis = found[0]
    found[0] = (first[:1].upper() + first[1:], emphasis)
    return [("I" if word == "i" else word, emphasis) for word, emphasis in found]
