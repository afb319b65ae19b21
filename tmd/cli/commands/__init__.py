"""The commands of ``tmd``: the options of each, and what it does with them.

To add one, copy the shortest, ``parse`` in :mod:`tmd.cli.commands.requests`, and name it in :mod:`tmd.cli.program`.
"""
