"""What an experiment's run is shown as: the table on the screen, the charts, and one self-contained page.

Begin with :mod:`tmd.evaluation.report.report`.
"""
