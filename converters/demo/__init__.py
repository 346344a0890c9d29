"""The demo of `./run demo`: real speech through small weights that were trained on a synthetic corpus,
or (--full-size) through the whole network with random ones, drawn as pages and pictures."""
