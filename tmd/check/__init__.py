"""The checker for people who write domains: every problem of their files at once, each with its place and a hint.

==================  ==============================================================================
module              holds
==================  ==============================================================================
``codes``           the kinds of problems, each an error or a warning (``docs/errors.md`` explains them)
``diagnostic``      one problem of a file; the list of them
``run``             what lies at a path, and checking all of it
``pddl_file``       domains and problems: all faults, without those that only follow from others
``data_files``        YAML and JSON Lines: which file is checked how, and with what
``yaml_files``        object classes, environments; ``words`` lexicons; ``demonstrations``
``possible``          what may ever hold in a problem, and which actions may ever apply
``find``            the domain that a problem belongs to
``lint_domain``     what is allowed in a domain and hardly ever meant
``lint_problem``    the same for problems: goals and actions that nothing reaches
==================  ==============================================================================
"""
