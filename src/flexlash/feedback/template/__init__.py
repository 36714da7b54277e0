"""The template: written empty, filled, or filled anew with what an older one holds."""
