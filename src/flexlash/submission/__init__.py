"""From a file to variants and findings, and back to its sender.

`reading` turns a file into raw cells, `validate` and the modules beside it turn cells into variants and findings,
`templating` writes the workbook that engineers fill, `marking` and `mending` hand it back marked or mended.
"""
