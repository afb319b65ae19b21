"""The JSON formats: one module each, with the classes that write it, read it and describe it.

===================  ==========================================================================
module               format
===================  ==========================================================================
``json_record``      the common base: strictness, and faults in one line
``clauses``          ``tmd parse --json``, and the clauses within a grounding
``grounding``        ``tmd ground --json``, with ``--goal-only`` as well
``run``              ``tmd run --json``, and the lines of ``tmd run --log``
``sentence_test``    ``tmd test --json``
``prediction``       a line of ``predictions.jsonl`` and of ``parts/`` in a run of ``tmd experiment``
``metrics``          ``metrics.json`` there
``fit``              a file of ``fits/`` there
``trial``            a file of ``robot/`` there
``schemas``          all of them as JSON Schema: ``python -m tmd.records DIR`` writes the files
===================  ==========================================================================

Begin with :mod:`tmd.json_record`, their common base. The code that fills them is beside its subject:
:mod:`tmd.view.grounding_record`, :mod:`tmd.robot_trials.trials`, :mod:`tmd.evaluation.runs.jobs`.
"""
