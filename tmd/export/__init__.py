"""Plans and problems in the forms that other tools read.

==================  ==============================================================================
module              holds
==================  ==============================================================================
``planned``         a problem with a plan that works: what everything here begins with
``end_goal``        what a text asks for, as one condition
``formats``         the formats by name, and the files that each consists of
``directory``       writing a directory, whole or not at all
``strips``          plan-resolved ground STRIPS, and plans for it brought back
``flat_types``      few types without a hierarchy, for ground problems
``durative``        PDDL 2.1: durative actions of a robot that does one thing at a time
``temporal``        plans with times: of PDDL 2.1, POPF and PlanSys2
``tree``            a behaviour tree for BehaviorTree.CPP 4
``record``          our own JSON, and its schema
``sas``             SAS+ by Fast Downward's translator
``unified``         unified-planning: its objects, ANML, its protocol buffers
``from_unified``    a problem of unified-planning as one of ours
==================  ==============================================================================
"""
