"""Texts and facts on pages: clauses in a text, what nouns came to mean, and conditions in plain words."""
