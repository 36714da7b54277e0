"""The marked copy: the engineer's own file, guilty cells coloured and noted, with a list of the findings."""

from flexlash.feedback.annotation.marked_copy import MarkedCopy, findings_workbook, marked_copy, marked_table

__all__ = ["MarkedCopy", "findings_workbook", "marked_copy", "marked_table"]
