"""Access control: addresses of this machine, the studio's own page, and the token.

Any page that is open in a visitor's browser can send requests to the studio's port. So each request is asked for three
things. ``Host`` must be an address of this machine, so that no foreign name that was made to point here is served. A
websocket's ``Origin``, which a browser always sends and no page can forge, must be the studio's own page. And the token
that was printed must be in the address, or in the cookie that the first visit with it set.
"""

from __future__ import annotations

import ipaddress
import os
import secrets
import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from hmac import compare_digest
from http import HTTPStatus
from http.cookies import CookieError, SimpleCookie
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs, urlencode, urlsplit

from tmd.diagnostics import OutputError, TmdError
from tmd.files import make_directory

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Request, Response

_FILE = "token"
_BYTES = 24
_LONGEST = 200
# The word in the address before the token.
TOKEN = "token"
_LOCAL = frozenset({"localhost", "127.0.0.1", "::1"})
_ANY = frozenset({"0.0.0.0", "::", ""})
# No other page may show the studio in a frame, and have its buttons pressed there.
_ALONE = "frame-ancestors 'none'"

_Answer = Callable[["ServerConnection", "Request"], "Response | None"]


def kept_token(directory: Path) -> str:
    """Return the token of a studio, kept in a file that only its user may read.

    Where it cannot be kept, it is a new one each time.
    """
    path = directory / _FILE
    token = secrets.token_urlsafe(_BYTES)
    with suppress(OSError, OutputError, UnicodeError):
        make_directory(directory)
        known = path.read_text(encoding="ascii").strip() if path.exists() else ""
        if len(known) >= _BYTES:
            return known
        path.unlink(missing_ok=True)
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="ascii") as file:
            file.write(token)
    return token


class Guard:
    """Access control of one server.

    ``port`` distinguishes the cookies of several studios; a visitor must know the ``token``.
    """

    def __init__(self, host: str, port: int, token: str) -> None:
        self._token = token
        self._cookie = f"tmd-studio-{port}"
        self._everywhere = host in _ANY
        names = {host} if not self._everywhere else {socket.gethostname().lower(), socket.getfqdn().lower()}
        self._names = _LOCAL | {name.lower() for name in names}

    def refusal(self, request: Request) -> str:
        """Return why a request is refused; empty where it is not."""
        hosts = request.headers.get_all("Host")
        if len(hosts) != 1 or not self._own(hosts[0]):
            return "this is not an address of the studio; use the one that it printed"
        origins = request.headers.get_all("Origin")
        if any(origin not in (f"http://{hosts[0]}", f"https://{hosts[0]}") for origin in origins):
            return "another page may not speak to the studio"
        if not self._knows(request):
            return "the token is missing or wrong: open the whole address that tmd studio printed"
        return ""

    def _own(self, host: str) -> bool:
        """Return whether this machine is called so; the port may be another one where it is forwarded."""
        try:
            name = (urlsplit(f"//{host}").hostname or "").lower()
        except ValueError:
            return False
        if name in self._names:
            return True
        try:
            ipaddress.ip_address(name)
        except ValueError:
            return False
        return self._everywhere  # by number: no foreign name can lead here

    def _knows(self, request: Request) -> bool:
        return any(
            compare_digest(known.encode(), self._token.encode()) for known in (*_said(request), self._kept(request))
        )

    def _kept(self, request: Request) -> str:
        cookies: SimpleCookie = SimpleCookie()
        with suppress(CookieError):
            cookies.load("; ".join(request.headers.get_all("Cookie")))
        return cookies[self._cookie].value if self._cookie in cookies else ""

    def answer(self, request: Request) -> Response | None:
        """Return a refusal, or the page's address without the token; ``None`` to go on."""
        why = self.refusal(request)
        if why:
            return response(HTTPStatus.FORBIDDEN, f"The studio does not answer: {why}.\n")
        if request.headers.get("Upgrade") is None and _said(request):
            address = urlsplit(request.path)
            rest = {key: values for key, values in parse_qs(address.query).items() if key != TOKEN}
            target = "/" + address.path.lstrip("/") + (f"?{urlencode(rest, doseq=True)}" if rest else "")
            cookie = f"{self._cookie}={self._token}; HttpOnly; SameSite=Strict; Path=/; Max-Age=31536000"
            return response(HTTPStatus.SEE_OTHER, "", {"Location": target, "Set-Cookie": cookie})
        return None


def _said(request: Request) -> list[str]:
    """Return the tokens in the address."""
    return [value[:_LONGEST] for value in parse_qs(urlsplit(request.path).query).get(TOKEN, [])]


def response(status: HTTPStatus, text: str, headers: dict[str, str] | None = None) -> Response:
    """Return an answer of plain text that nothing keeps."""
    from websockets.datastructures import Headers
    from websockets.http11 import Response

    body = text.encode()
    told = {"Content-Type": "text/plain; charset=utf-8", "Content-Length": str(len(body)), "Cache-Control": "no-store"}
    return Response(status, status.phrase, Headers({**told, **(headers or {})}), body)


@contextmanager
def guarding(guard: Guard, own: _Answer, change: Callable[[Request, Response], Response]) -> Iterator[None]:
    """Have the guard asked first for everything that is served over websockets within this context.

    viser starts its server itself, and hands nothing of this on (1.1.1); what it calls is replaced while it starts.

    ``own`` answers what viser knows nothing of; ``change`` is what becomes of a page before it is sent.

    Raises:
        TmdError: Nothing was served: it would be served unguarded.
    """
    from websockets.asyncio import server

    serve, asked = server.serve, []

    def guarded(*args: Any, process_request: _Answer, **more: Any) -> Any:  # noqa: ANN401 - as serve has it
        def answer(connection: ServerConnection, request: Request) -> Response | None:
            said = guard.answer(request) or own(connection, request)
            if said is not None:
                return said
            found = process_request(connection, request)
            return None if found is None else _alone(change(request, found))

        asked.append(True)
        return serve(*args, process_request=answer, **more)

    server.serve = guarded  # type: ignore[assignment,misc]
    try:
        yield
    finally:
        server.serve = serve  # type: ignore[misc]
    if not asked:
        raise TmdError("this version of viser cannot be guarded", hint="pip install 'viser==1.1.1'")


def _alone(response: Response) -> Response:
    response.headers["Content-Security-Policy"] = _ALONE
    response.headers["Referrer-Policy"] = "no-referrer"
    return response
