"""Word lists and WordNet subsets, and the script that rebuilds them."""
