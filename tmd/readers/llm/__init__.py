"""The language model as a reader: it proposes PDDL goals, and everything it says is checked.

Begin with :mod:`tmd.readers.llm.reader`. :mod:`~tmd.readers.llm.prompt` says what the model is told (the words are in
``prompt.txt``), :mod:`~tmd.readers.llm.reply` what it may answer, :mod:`~tmd.readers.llm.checking` which answers are
accepted, and :mod:`~tmd.readers.llm.client` how it is reached.
"""
