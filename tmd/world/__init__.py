"""Object graphs and environments, compiled to PDDL (section III-B of the paper).

==================  ==============================================================================
module              holds
==================  ==============================================================================
``yaml_source``     reading YAML so that every fault has a line and a column
``classes``         object classes as directed part graphs (``objects.yaml``)
``environment``     environments: which objects there are, where, in what state
``folder``          a domain folder, and where folders are found
``compile``         classes + instructions to ``domain.pddl``; an environment to a PDDL problem
``veil500``         the reader of the VEIL-500 data set
==================  ==============================================================================
"""
