"""The service: submissions handed in by a page or a drop folder, kept in a store, computed, delivered."""
