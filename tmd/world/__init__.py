"""Object graphs and environments, compiled to PDDL (section III-B of the paper), and the files of a domain.

Begin with :mod:`tmd.world.compile`: it makes a domain of object :mod:`~tmd.world.classes` and a problem of an
:mod:`~tmd.world.environment`. A :class:`~tmd.world.world.World` is such a problem, grounded. :mod:`~tmd.world.roots`
and :mod:`~tmd.world.corpus` find environments and demonstrations, :mod:`~tmd.world.scaffold` writes new domains.
"""
