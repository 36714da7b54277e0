"""Excel in, tolerance-spread report out."""
__version__ = "0.1.0"
