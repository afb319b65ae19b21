"""Plans and problems in the forms that other tools read, and the way back from unified-planning and ``pddl``.

Begin with :mod:`tmd.export.formats`, the table of all formats; :mod:`~tmd.export.planned_problem` is what each of them
is given. :mod:`~tmd.export.end_goal` states what a text asks for as the goal of a problem.
"""
