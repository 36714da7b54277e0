"""One variant in live formulas, from its inputs to backlash and stress."""
