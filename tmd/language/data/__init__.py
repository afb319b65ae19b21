"""All English of the parser: words, rows of classes and of phrases, and subsets of WordNet."""
