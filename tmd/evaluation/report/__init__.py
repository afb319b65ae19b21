"""Reports of an experiment's run: the table on the screen, the charts, and one self-contained page.

Begin with :mod:`tmd.evaluation.report.report`.
"""
