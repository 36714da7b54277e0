"""Parametric studies: how backlash, its spread and the stress go with one dimension, or with two."""
