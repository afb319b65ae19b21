"""``python -m tmd``: the same as ``tmd``."""

from tmd.cli import main

main()
