"""What goes back to the engineer: the template, the marked copy, the fixed file."""
