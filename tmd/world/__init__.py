"""Object graphs and environments, compiled to PDDL (section III-B of the paper).

Begin with :mod:`tmd.world.compile`; it makes a domain of object :mod:`~tmd.world.classes` and a problem of an
:mod:`~tmd.world.environment`. :mod:`~tmd.world.folder` knows the files of a domain, :mod:`~tmd.world.scaffold` writes
new ones.
"""
