"""Training of the thesis' models: a corpus, its features, the regimes, and the weights that come out."""
