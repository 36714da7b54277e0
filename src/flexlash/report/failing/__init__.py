"""One printed page for each of the worst variants that miss their limit."""
