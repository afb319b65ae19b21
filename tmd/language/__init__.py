"""Text to verb clauses, and nouns to the things of an environment (section III-A of the paper)."""
