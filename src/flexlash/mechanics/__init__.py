"""Wind-up and stresses of a flexspline, in SI units, for arrays of any shape; no randomness."""
