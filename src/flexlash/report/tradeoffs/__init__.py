"""The sheet Trade-offs: variants beside each other, and how the worst of them follow each dimension."""
