"""The demo of `./run demo`: real speech through ZS-MSTM 1.0 at full size, drawn as a picture.

The speech is real; everything that no free source exists for is made up and said to be: the weights
are random, the word vectors are hashes, the style clip's pose is a procedural wave of the arms.
"""
