"""From variants to results: nominal numbers, tolerance spread, elasticity check."""
