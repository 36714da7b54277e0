"""Changing a few places of a workbook and leaving every other byte: what is not written anew cannot be lost."""
