"""The PR2 in pybullet: scene, motion, skills, and the check of every effect after every instruction.

Begin with :mod:`tmd.robot.run_plan`, the one driver of an execution. ``sim/`` is pybullet behind one class, ``assets/``
what things look like, ``scene/`` what stands where, ``pr2/`` the robot and its motion, ``skills/`` what it can do,
``monitor/`` the executor and what it reads back, ``video/`` films and pictures.
"""
