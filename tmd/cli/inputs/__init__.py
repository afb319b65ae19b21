"""What commands are given: texts, environments, plans, artefacts, read from options, files and standard input."""
