"""A submission and what is certain about its faults → a new submission in which they are fixed, each one listed."""
