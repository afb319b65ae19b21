"""The commands of ``tmd``: one module for each, with its options and what it does with them.

To add one, copy the shortest, :mod:`tmd.cli.commands.parse`, and name it in :data:`tmd.cli.program.COMMANDS`.
"""
