"""The studio's own script and style in viser's page, and what that script asks the server for.

The script (``data/page.js``) does in the browser what a program on the server cannot: it says when the studio has ended
and loads the page again when it is back, keeps what the window looks at in its address, follows the system's dark mode,
and gives names to what has none.
"""

from __future__ import annotations

import gzip
import secrets
from functools import cache
from http import HTTPStatus
from importlib.resources import files
from typing import TYPE_CHECKING

from tmd.studio.guard import response

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Request, Response

ALIVE = "/alive"
"""Asked for by the page, to know whether the studio is there."""
_INSTANCE = secrets.token_hex(8)
"""Of this process: the page knows by it that the studio was started again."""
_HEAD = b"<head>"


def answer(_connection: ServerConnection, request: Request) -> Response | None:
    """What viser knows nothing of; ``None`` for the rest."""
    return response(HTTPStatus.OK, _INSTANCE) if _path(request) == ALIVE else None


def with_script(request: Request, page: Response) -> Response:
    """The page of viser with the studio's script and style; anything else as it is."""
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
