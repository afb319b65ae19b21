"""Demonstrations in progress: sessions, drafts, corrections, and the store of finished ones.

Begin with :mod:`tmd.studio.demonstrations.session`.
"""
