"""Signals: a request to stop by another program is treated as Ctrl-C, so that files are finished first."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager

_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Stopped(KeyboardInterrupt):
    """The program shall stop.

    It has a type of its own because of a habit of Python: a plain KeyboardInterrupt that passes through ``exec`` of a
    text (making a dataclass is enough) lets the interpreter end by SIGINT, whatever exit code it was given later.
    """


@contextmanager
def stoppable() -> Iterator[None]:
    """SIGINT, SIGTERM and SIGHUP are raised as :class:`Stopped`, but those that whoever started us wants ignored."""

    def stop(number: int, frame: object) -> None:
        raise Stopped

    heard = [number for number in _SIGNALS if signal.getsignal(number) is not signal.SIG_IGN]
    before = {number: signal.signal(number, stop) for number in heard}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
