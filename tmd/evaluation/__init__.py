"""Experiments: data sets, models to compare, metrics, folds, and run directories.

==================  ==============================================================================
module              holds
==================  ==============================================================================
``metrics``         IED, END, EED and EED-trim
``dataset``         what an experiment needs of a data set; the bundled one and VEIL-500
``models``          what is compared, each behind one small interface
``crf``             the paper's own model among them, with its ablations
``folds``           who is trained on what
``experiment``      the steps of a run, and its directory
``summary``         means and standard errors
``report``          the table on the screen and the page
==================  ==============================================================================
"""
