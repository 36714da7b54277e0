"""Tolerance."""
