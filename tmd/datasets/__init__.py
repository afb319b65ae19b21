"""Data sets of others: reading them, and what they say as PDDL."""
