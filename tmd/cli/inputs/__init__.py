"""The inputs of commands: options, texts, plans and problems.

Begin with :mod:`tmd.cli.inputs.options`, the options that many commands share.
"""
