"""Two reports or submissions side by side: what was entered, what it uses, what came out."""
