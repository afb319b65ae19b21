"""``provenance.json`` of ``tmd experiment``: when, where and by which command a run was made."""

from __future__ import annotations

from tmd.json_record import JsonRecord


class Provenance(JsonRecord):
    """Circumstances of a run. They decide nothing, and differ between runs that are otherwise the same."""

    WHAT = "the provenance of a run of tmd experiment"
    REMAKE = "remove that file; the page will lack date, machine and time"

    command: str
    date: str
    seconds: float
    machine: str
    python: str
    revision: str
