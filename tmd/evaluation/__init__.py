"""Experiments: data sets, models to compare, metrics, folds, and run directories.

==================  ==============================================================================
module              holds
==================  ==============================================================================
``metrics``         success, IED, END, EED and EED-trim
``dataset``         what an experiment needs of a data set; the bundled one and VEIL-500
``config``          what a run is asked to do, and which part of that decides its outcome
``protocol``        which tasks are trained together
``folds``           who is trained on what
``incomplete``      sentences left out of a text at random
``prediction``      what a model says of an example, clause by clause
``models``          what is compared, each behind one small interface
``crf``             the paper's own model among them, its ablations, and our variants
``predefined``      Predefined Templates: a library that people wrote; ``template_file`` its file
``tree``            Instruction-Tree Search
``units``           the unit of work: one model, one training set, the folds that share it
``backends``        who does the units: this process, others on this machine, a cluster
``cluster``         units on the workers of a dask scheduler
``rundir``          a run's directory
``experiment``      the steps of a run
``summary``         means, standard errors, averages over tasks, the floor
``significance``    paired tests between all rows
``standing``        which row the others are measured against, and which differ from it
``records``         what a run left in its directory, read and checked
``report``          the table on the screen, and the page
``page``            the page as one self-contained file
``paper_table``     Table II of the paper
``tables``          differences, weights and errors as tables
``figures``         the charts
``confusion``       where predictions go wrong: by verb, and instruction by instruction
``examples``        which predictions a report shows
``alignment``       what was predicted beside what the person did, step by step
==================  ==============================================================================
"""
