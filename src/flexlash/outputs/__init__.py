"""Where files go: named, numbered and planned before anything is computed, written whole, never over the user's own."""
