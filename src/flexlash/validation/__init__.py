"""From cells with addresses to variants and findings."""
