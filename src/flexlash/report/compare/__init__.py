"""Variants side by side: percentile boxes, ranking with differences to a base, what causes the spread."""
