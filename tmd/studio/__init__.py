"""The studio, a page in the browser: say something, watch the plan, correct it, demonstrate another.

Begin with :mod:`tmd.studio.server`, which makes a :class:`~tmd.studio.visitor.Visitor` for each page that is open.
:mod:`~tmd.studio.panels` are what is clicked, :mod:`~tmd.studio.view3d` what is looked at,
:mod:`~tmd.studio.demonstrations` what is saved, :mod:`~tmd.studio.teaching` what is learned of it.
"""
