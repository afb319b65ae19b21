"""Nobody but who has the token, on the studio's own page, is answered."""

from __future__ import annotations

import socket
import stat
from collections.abc import Iterator
from http.client import HTTPConnection
from pathlib import Path

import pytest

pytest.importorskip("viser", reason="needs the extra studio")

import viser

from tmd.diagnostics import TmdError
from tmd.studio.guard import Guard, guarding, kept_token
from tmd.studio.server import Server
from tmd.studio.studio import Studio
from tmd.studio.teaching import Teacher
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TMD_STUDIO_STATE", str(tmp_path_factory.mktemp("drafts")))
        root = Path(__file__).parents[2]
        corpus = Corpus(DomainFolder(root / "domains" / "02_table"), root / "problems" / "02_table")
        served = Server(Studio(corpus, Teacher(corpus), "corner1"), "127.0.0.1", 0)
        yield served
        served.close()


def get(server: Server, path: str, **headers: str) -> tuple[int, dict[str, str], str]:
    connection = HTTPConnection("127.0.0.1", server.port, timeout=20)
    connection.putrequest("GET", path, skip_host="Host" in headers)
    for name, value in headers.items():
        connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    found = answer.status, dict(answer.getheaders()), answer.read().decode("utf-8", "replace")
    connection.close()
    return found


def handshake(server: Server, path: str, origin: str | None, host: str | None = None, cookie: str = "") -> int:
    """The status that a websocket is answered with; 101 where it is opened."""
    told = {
        "Host": host or f"127.0.0.1:{server.port}", "Upgrade": "websocket", "Connection": "Upgrade",
        "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
        "Sec-WebSocket-Protocol": f"viser-v{viser.__version__}",
    } | ({"Origin": origin} if origin else {}) | ({"Cookie": cookie} if cookie else {})  # fmt: skip
    with socket.create_connection(("127.0.0.1", server.port), timeout=20) as stream:
        stream.sendall(f"GET {path} HTTP/1.1\r\n".encode() + "".join(f"{k}: {v}\r\n" for k, v in told.items()).encode())
        stream.sendall(b"\r\n")
        return int(stream.makefile("rb").readline().split()[1])


def test_the_token_opens_the_page_and_stays_in_a_cookie(server: Server) -> None:
    status, headers, _ = get(server, f"/?token={server.token}&say=Take+the+cup.")
    assert status == 303 and headers["Location"] == "/?say=Take+the+cup."
    cookie = headers["Set-Cookie"]
    assert "HttpOnly" in cookie and "SameSite=Strict" in cookie
    status, headers, text = get(server, "/", Cookie=cookie.partition(";")[0])
    assert status == 200 and "<title>tmd studio</title>" in text
    assert "frame-ancestors 'none'" in headers["Content-Security-Policy"]
    assert get(server, f"//evil.example/?token={server.token}")[1]["Location"] == "/"


@pytest.mark.parametrize(
    "path", ["/", "/alive", "/?token=wrong", "/?token=", "/?token=" + "x" * 5000, "/?token=%00%C3"]
)
def test_without_the_token_nothing_is_served(server: Server, path: str) -> None:
    status, _, text = get(server, path)
    assert status == 403 and "open the whole address" in text
    assert handshake(server, path, None) == 403


def test_a_foreign_name_that_points_here_is_not_served(server: Server) -> None:
    path = f"/?token={server.token}"
    for host in ("evil.example", f"evil.example:{server.port}", "127.0.0.1.evil.example", "10.1.2.3", "[", ""):
        assert get(server, path, Host=host)[0] in (400, 403), host
    assert handshake(server, path, None, host="evil.example") == 403
    for host in (f"localhost:{server.port}", "127.0.0.1:9000", f"[::1]:{server.port}"):
        assert get(server, path, Host=host)[0] == 303


def test_another_page_of_the_same_browser_is_turned_away(server: Server) -> None:
    own = f"http://127.0.0.1:{server.port}"
    cookie = f"tmd-studio-{server.port}={server.token}"
    assert handshake(server, "/", own, cookie=cookie) == 101
    others = ("http://localhost:9009", "http://127.0.0.1:9009", "https://evil.example", "null", f"{own}.evil.example")
    for origin in (*others, f"ftp://127.0.0.1:{server.port}"):
        assert handshake(server, "/", origin, cookie=cookie) == 403, origin
    assert handshake(server, "/", own) == 403
    assert handshake(server, "/", own, cookie=f"tmd-studio-{server.port}=wrong") == 403


def test_where_everybody_may_come_numbers_are_served_and_foreign_names_are_not() -> None:
    from websockets.datastructures import Headers
    from websockets.http11 import Request

    guard = Guard("0.0.0.0", 8080, "secret")

    def why(host: str, path: str = "/?token=secret") -> str:
        return guard.refusal(Request(path, Headers({"Host": host})))

    assert why("192.168.1.7:8080") == why("localhost:8080") == ""
    assert "not an address" in why("evil.example:8080")
    assert "token" in why("192.168.1.7:8080", "/")


def test_the_token_is_kept_for_its_user_alone(tmp_path: Path) -> None:
    token = kept_token(tmp_path / "state")
    file = tmp_path / "state" / "token"
    assert kept_token(tmp_path / "state") == token and len(token) >= 24
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    file.write_text("short")
    assert len(kept_token(tmp_path / "state")) >= 24
    (tmp_path / "taken").write_text("")
    assert kept_token(tmp_path / "taken") != kept_token(tmp_path / "taken")


def test_what_cannot_be_guarded_is_not_served() -> None:
    with (
        pytest.raises(TmdError, match="cannot be guarded"),
        guarding(Guard("127.0.0.1", 0, "x"), lambda *_: None, lambda _, page: page),
    ):
        pass
