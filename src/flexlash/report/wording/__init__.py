"""The report's sentences and labels."""
