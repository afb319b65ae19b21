"""The object graph of an object (section III-B of the paper) as SVG: what it is made of, its layout, its picture.

Begin with :mod:`tmd.view.object_graph.graph`.
"""
