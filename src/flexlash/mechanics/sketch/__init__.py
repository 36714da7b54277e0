"""A sketch of a part with its dimensions, to scale: drawn once, for pages and workbooks."""
