"""The studio's own script and style in viser's page, and the requests of that script.

The script (``data/page.js``) does in the browser what a program on the server cannot: it says when the studio has ended
and loads the page again when it is back, keeps what the window looks at in its address, follows the system's dark mode,
and gives names to what has none.
"""

from __future__ import annotations

import gzip
import json
import secrets
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import cache
from http import HTTPStatus
from importlib.resources import files
from threading import Lock
from typing import TYPE_CHECKING, Annotated
from urllib.parse import parse_qsl, urlencode

from pydantic import BaseModel, Field, TypeAdapter, ValidationError

from tmd.studio.guard import response

if TYPE_CHECKING:
    from viser import ClientHandle
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Request, Response

# Asked for by the page, to know whether the studio is there.
ALIVE = "/alive"
# Of this process: the page knows by it that the studio was started again.
_INSTANCE = secrets.token_hex(8)
_HEAD = b"<head>"
# The key in the window's storage under which the script answers.
KEY = "tmd-page"
# The label of the input through which it sends events.
EVENT = "tmdevent"
# Seconds that a window may take to answer.
_PATIENCE = 5.0
# Characters of an event, or of an address, that are read.
_LONGEST = 20_000
# Numbers in an address are smaller.
_MOST = 1_000_000


def answer(_connection: ServerConnection, request: Request) -> Response | None:
    """Answer the requests that viser does not know; ``None`` for the rest."""
    return response(HTTPStatus.OK, _INSTANCE) if _path(request) == ALIVE else None


def with_script(request: Request, page: Response) -> Response:
    """Return the page of viser with the studio's script and style; anything else as it is."""
    if _path(request) not in ("/", "/index.html") or page.status_code != HTTPStatus.OK or page.body is None:
        return page
    packed = page.headers.get("Content-Encoding") == "gzip"
    page.body = _extended(bytes(page.body), packed=packed)
    for name, value in (("Content-Length", str(len(page.body))), ("Cache-Control", "no-store")):
        if name in page.headers:
            del page.headers[name]
        page.headers[name] = value
    return page


@cache
def _extended(body: bytes, *, packed: bool) -> bytes:
    html = gzip.decompress(body) if packed else body
    data = files("tmd.studio") / "data"
    script, style = ((data / name).read_text(encoding="utf-8") for name in ("page.js", "page.css"))
    own = f"<script>{script}</script><style>{style}</style>".encode()
    html = html.replace(_HEAD, _HEAD + own, 1).replace(b"<title>Viser</title>", b"<title>tmd studio</title>", 1)
    return gzip.compress(html, mtime=0) if packed else html


def _path(request: Request) -> str:
    return request.path.partition("?")[0]


class PageLink(BaseModel, frozen=True):
    """View of a window as its address states it.

    Attributes:
        environment: The environment; empty for the first.
        say: The sentence; empty for none.
        plan: The number of its plan, from 1.
        step: After how many steps it is seen.
        tab: The tab that is open.
    """

    environment: str = ""
    say: str = ""
    plan: Annotated[int, Field(ge=1, lt=_MOST)] = 1
    step: Annotated[int, Field(ge=0, lt=_MOST)] = 0
    tab: str = ""

    def query(self) -> str:
        """Return the address, from the question mark on."""
        told = self.model_dump(exclude_defaults=True)
        return f"?{urlencode(told)}" if told else ""


def read_link(query: str) -> PageLink:
    """Read an address; an invalid one leads to the beginning."""
    try:
        return PageLink.model_validate(dict(parse_qsl(query.lstrip("?")[:_LONGEST])))
    except ValueError:
        return PageLink()


class Event(BaseModel):
    """Event in a window; one kind of event has one of the fields, or two.

    Attributes:
        number: Its number in the window.
        dark: Whether the system became dark.
        tab: The tab that was opened.
        step: The step that was clicked, in ``list``.
        list: The panel of the step.
        object: The object that was clicked in a graph.
        clicked: Whether the picture was clicked.
    """

    number: int
    dark: bool | None = None
    tab: str = ""
    step: int | None = None
    list: str = ""
    object: str = ""
    clicked: bool = False


_EVENTS = TypeAdapter(list[Event])


class _Stored(BaseModel):
    """State of a window when it was loaded: its address, and whether its system is dark."""

    search: str = ""
    dark: bool = False


def stored(client: ClientHandle, key: str) -> str:
    """Return what a browser keeps under a key; nothing where it does not answer."""
    try:
        return client.local_storage.get_item(key, timeout=_PATIENCE) or ""
    except (RuntimeError, TimeoutError):
        return ""


class Window:
    """A window of a browser, beside what viser shows in it.

    ``told`` is called with each event in it.

    Attributes:
        dark: Whether its system is dark.
        link: The view that its address had when it was loaded.
    """

    def __init__(self, client: ClientHandle, told: Callable[[Event], None]) -> None:
        self._client = client
        try:
            kept = _Stored.model_validate_json(stored(client, KEY) or "{}")
        except ValidationError:
            kept = _Stored()
        self.dark = kept.dark
        self.link = self._kept = read_link(kept.search)
        self._told = told
        self._seen = 0
        self._lock = Lock()
        self._event = client.gui.add_text(EVENT, "")
        self._event.on_update(lambda _: self._happened())

    def _happened(self) -> None:
        """Pass on the events since the last time; the script sends the last few events together."""
        with suppress(TypeError, ValueError):
            for event in _EVENTS.validate_json(self._event.value[:_LONGEST]):
                if self._is_new(event.number):
                    self._told(event)

    def _is_new(self, number: int) -> bool:
        """Return whether an event is new, and remember it."""
        with self._lock:
            new, self._seen = number > self._seen, max(number, self._seen)
            return new

    def keep(self, link: PageLink) -> None:
        """Let the address say what is looked at."""
        if link != self._kept:
            self._kept = link
            self._tell({"link": link.query()})

    def show_tab(self, name: str) -> None:
        """Open a tab."""
        self._tell({"tab": name})

    def _tell(self, words: Mapping[str, object]) -> None:
        (kind,) = words
        self._client.local_storage.set_item(f"{kind}-{KEY}", json.dumps(words))  # of one key viser sends the last only
