"""The Explorer: one variant, any limit, read off stored percentiles by plain formulas."""
