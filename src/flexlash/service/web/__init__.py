"""The page: what the store has, over HTTP, as pages and as JSON."""
