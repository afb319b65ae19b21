"""Filling the gaps of a plan: the cheapest missing instructions, or the reason why there are none."""
