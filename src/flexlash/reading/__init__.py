"""A file → raw cells, or a refusal by name: the gate, the limited process behind it, and one reader a format."""
