"""What to change: single changes of a variant that meet its limit, tolerances of a class, sweeps, trade-offs."""
