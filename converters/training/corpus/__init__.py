"""A synthetic corpus: espeak-ng reads sentences of a grammar, a parametric gesturer moves to them.

grammar.py sentences with known dialog acts   texts.py monologues and their splits
espeak.py, speech.py sound and word times     prosody.py what a gesturer hears
style.py, strokes.py, arms.py, figure.py, face.py, landmarks.py, gesture.py motion
recordings.py, command.py the folder          docs/training-data.md has the formulas
"""
