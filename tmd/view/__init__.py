"""Pages on plans: one HTML page that needs nothing else, and its pieces.

Begin with :mod:`tmd.view.page`, the whole page about a :class:`~tmd.view.subject.Subject`;
:mod:`~tmd.view.sources` finds the subject in a file. :mod:`~tmd.view.clauses` and :mod:`~tmd.view.candidates` return
fragments for any page with :func:`tmd.view.markup.style`. :mod:`~tmd.view.answer_text` is for terminals.
"""
