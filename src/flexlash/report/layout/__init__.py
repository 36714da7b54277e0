"""How the report looks: styles, links, formats, paper."""
