"""PDDL: its nouns, its semantics, reading, writing, grounding and validating.

======================  ==========================================================================
module                  holds
======================  ==========================================================================
``model``               types, objects, atoms, formulas, effects, action schemas, domain, problem
``hierarchy``           which type is a kind of which, and the objects of each type
``syntax``              words and groups with their places; ``parentheses`` makes them from text
``read_names``          names, typed lists and numbers
``read_formula``        conditions and effects
``read_sections``       the sections of domains and problems; ``read_init`` the initial state
``reader``              domains and problems from text
``check``               every fault of a domain or problem, with place and hint
``check_requirements``  features used without their requirement
``portable``            problems in the form that other planners read
``goal``                a goal written by itself
``writer``              domains and problems as flat typed ADL
``plan_file``           plans and single instructions as text
``semantics``           what PDDL means: ``holds``, ``apply`` (the paper's Φ), ``regress``
``regress``             the inverse of Φ, on the ground form
``task``                the ground form that searching uses: states and conditions as bit sets
``grounding``           from a problem to its task; its steps are ``instantiate`` and ``prune``
``ground_action``       actions over numbered atoms, while grounding
``normal_form``         ground conditions as clauses or cubes
``conjunctions``        conditions before they are ground: conjuncts, predicates, free variables
``join``                bindings that satisfy a conjunction
``reachability``        which literals may ever hold and which rules may ever fire
``simulator``           executing sequences by force, for scoring
``validator``           whether a plan works, and the first reason why it does not
======================  ==========================================================================
"""
