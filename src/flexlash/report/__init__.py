"""The outcome as a file: a workbook with one module a sheet, or the Results table alone."""
