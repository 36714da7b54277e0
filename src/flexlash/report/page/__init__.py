"""The outcome as plain facts for a page: the report's own words and numbers, bounded, and JSON throughout."""
