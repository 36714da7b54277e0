"""From variants to results: nominal numbers, tolerance spread, recommendations, elasticity check."""
