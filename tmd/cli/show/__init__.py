"""The results of commands as lines for people: clauses, goals, plans, runs and warnings."""
