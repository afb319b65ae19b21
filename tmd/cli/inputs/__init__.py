"""What commands are given: texts, environments, plans, artefacts, read from options, files and standard input.

Begin with :mod:`tmd.cli.inputs.grounding`, the options of ``tmd ground`` that many commands share.
"""
