"""Many submissions, large tables, several processes or machines: one function, asked of an executor."""
