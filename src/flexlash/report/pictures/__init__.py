"""Pictures as SVG and PNG: the charts of the page, of files for slides and documents, from one code."""
