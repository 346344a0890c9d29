"""Forwards of the networks in converters/reference for whole batches: the same modules and keys,
with the batch as the first dimension of every tensor."""
