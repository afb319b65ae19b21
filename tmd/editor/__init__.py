"""The language server for PDDL and the YAML files of domains; all that it knows comes from the other packages.

Begin with :mod:`tmd.editor.language_server`, which answers editors. :mod:`~tmd.editor.names` and
:mod:`~tmd.editor.yaml_names` find the names in a text, :mod:`~tmd.editor.project` connects those of related files, and
:mod:`~tmd.editor.completion` proposes what fits at a place.
"""
