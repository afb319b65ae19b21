"""The web server of the studio: one browser after the other becomes a visitor."""

from __future__ import annotations

import errno
import logging
import socket
import time
import warnings
from contextlib import redirect_stdout, suppress
from importlib import import_module
from io import StringIO
from pathlib import Path
from threading import Event, Lock, Thread
from types import ModuleType
from typing import TYPE_CHECKING

from tmd.diagnostics import MissingToolError, TmdError, install_extra
from tmd.studio import page
from tmd.studio.guard import TOKEN, Guard, guarding, kept_token
from tmd.studio.panels import furnish
from tmd.studio.studio import Studio
from tmd.studio.visitor import KEY, Visitor

if TYPE_CHECKING:
    from viser import ClientHandle, ViserServer

LOCAL = "127.0.0.1"
_TRIES = 8
# Number of windows of one browser that are recognised when they come back.
_WINDOWS = 8
# Seconds between two looks at learning that is under way.
_LOOK = 0.5
_CHANGED = "Files of the domain have changed on disk: start tmd studio again to use them."
# Seconds that closing waits for what is compiled ahead: but for the first time ever, it is only loaded.
_WARMING = 5.0


class Server:
    """Web server of a studio.

    With ``port`` 0 a free one is taken.

    Attributes:
        url: Where it is reached from this machine, with the token.

    Raises:
        TmdError: The port is in use, or may not be listened at.
    """

    def __init__(self, studio: Studio, host: str, port: int) -> None:
        viser = need_viser()
        port = free_port(host, port)
        for name in ("websockets", "asyncio"):  # invalid requests are not answered, and need no log
            logging.getLogger(name).setLevel(logging.CRITICAL)
        warnings.filterwarnings("ignore", message="Queued a .* on a closed connection")
        self.studio = studio
        self.token = kept_token(studio.drafts.directory)
        guard = Guard(host, port, self.token)
        self._lock = Lock()
        self._visitors: dict[int, Visitor] = {}
        with redirect_stdout(StringIO()), guarding(guard, page.answer, page.with_script):  # it greets in its own way
            self._viser: ViserServer = viser.ViserServer(host=host, port=port, label="tmd studio", verbose=False)
        self.port = port
        name = LOCAL if host in ("0.0.0.0", "::") else f"[{host}]" if ":" in host else host
        self.url = f"http://{name}:{port}/?{TOKEN}={self.token}"
        self._ended = Event()
        self._warming = Thread(target=studio.warm, daemon=True)
        self._warming.start()
        Thread(target=self._follow, daemon=True).start()
        self._viser.on_client_connect(self._arrive)
        self._viser.on_client_disconnect(self._leave)

    def _arrive(self, client: ClientHandle) -> None:
        visitor = Visitor(self.studio, client, self._identity(client))
        furnish(visitor)
        with self._lock:
            self._visitors[client.client_id] = visitor
            if self.studio.teacher.learning:
                visitor.learning(True)
        if client.client_id not in self._viser.get_clients():  # it was closed meanwhile
            self._leave(client)
        visitor.guarded(visitor.come_back)(None)

    def _identity(self, client: ClientHandle) -> str:
        """Return the name of a window, by which its drafts are found when it is loaded again.

        A window takes a name of the browser that no other window has now, rather one with something that was not saved.
        """
        said, drafts = page.stored(client, KEY), self.studio.drafts
        names = list(dict.fromkeys(said.split(",")[:_WINDOWS])) if said else []
        kept = [name for name in names if drafts.kept(name)]
        for known in (kept, [name for name in names if name not in kept]):
            for _ in range(_TRIES if known else 0):
                for name in known:
                    with suppress(TmdError):
                        return drafts.enter(name)
                time.sleep(0.2)  # the page was loaded again, and who was here has not left yet
        identity = drafts.enter()
        names = list(dict.fromkeys([*kept, identity, *names]))
        client.local_storage.set_item(KEY, ",".join(names[:_WINDOWS]))
        return identity

    def _leave(self, client: ClientHandle) -> None:
        with self._lock:
            visitor = self._visitors.pop(client.client_id, None)
        if visitor is not None:
            visitor.stop()
            visitor.halt()
            self.studio.drafts.leave(visitor.identity)

    def _follow(self) -> None:
        """Tell every visitor when learning begins and when it ends, and when files of the domain change."""
        teacher, files = self.studio.teacher, self._files()
        told: tuple[bool, Exception | None] = False, None
        while not self._ended.wait(_LOOK):
            learning, now = (teacher.learning, teacher.error), self._files()
            with self._lock:
                visitors = list(self._visitors.values())
            for visitor in visitors:
                if learning != told:
                    visitor.learning(*learning)
                if now != files:
                    visitor.tell(_CHANGED, "What was not saved is kept.", aloud=True)
            told, files = learning, now

    def _files(self) -> dict[Path, int]:
        """Return when each file of the domain and of its environments was changed."""
        corpus, found = self.studio.corpus, {}
        for path in (*corpus.folder.path.iterdir(), *(corpus.directory / "environments").glob("*")):
            with suppress(OSError):
                found[path] = path.stat().st_mtime_ns
        return found

    def serve(self, ended: Event | None = None) -> None:
        """Serve until ``ended`` is set, or until the user stops it."""
        wait = ended or Event()
        while not wait.wait(0.2):  # signals are seen in between
            pass

    def close(self) -> None:
        """Stop serving, and what is learned meanwhile."""
        self._ended.set()
        self.studio.teacher.close()
        with redirect_stdout(StringIO()):
            self._viser.stop()
        # a thread that Python ends while it is in the compiler, which is C++, aborts the whole process
        self._warming.join(_WARMING)


def need_viser() -> ModuleType:
    """Return the package that puts the scene and the panels into browsers.

    Raises:
        MissingToolError: It is not installed.
    """
    try:
        return import_module("viser")
    except ImportError as error:
        raise MissingToolError("the studio needs the package viser", hint=install_extra("studio")) from error


def free_port(host: str, port: int) -> int:
    """Return the port, if it can be listened at; a free one for 0.

    Raises:
        TmdError: It cannot.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, port))
        except (OSError, TypeError) as error:  # a name that no host can have is a TypeError
            if isinstance(error, OSError) and error.errno == errno.EADDRINUSE:
                message, hint = f"port {port} is in use", "another studio may run already; name another: --port 8081"
            else:
                said = getattr(error, "strerror", None) or error
                message, hint = f"{host}:{port} cannot be listened at: {said}", "see --host, --port"
            raise TmdError(message, hint=hint) from error
        return int(probe.getsockname()[1])
