"""What commands print: clauses, goals, plans, runs and warnings, as JSON and as lines for people."""
