"""The panels of the studio's page: say, correct, demonstrate, and the object that was pointed at.

Begin with :mod:`tmd.studio.panels.context`, what a panel is given.
"""
