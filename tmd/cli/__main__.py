"""``python -m tmd.cli``: the same as ``tmd``."""

from tmd.cli import main

main()
