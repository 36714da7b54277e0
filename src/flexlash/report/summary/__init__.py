"""The Summary: one page of sentences, numbers and a chart, made for a design review."""
