"""A visitor without a browser: speaks the studio's protocol over its websocket, as quickly as a program can."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import Any, Self

import msgspec
import viser
import zstandard
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from tmd.studio.page import EVENT, KEY

WAIT = 180.0
_CAMERA = {
    "type": "ViewerCameraMessage", "wxyz": (1.0, 0.0, 0.0, 0.0), "position": (0.0, 0.0, 1.0), "fov": 1.0, "near": 0.01,
    "far": 100.0, "image_height": 480, "image_width": 640, "look_at": (1.0, 0.0, 1.0), "up_direction": (0.0, 0.0, 1.0),
}  # fmt: skip
"""A page says first how it looks at the scene."""


class Wire:
    """One connection; what the page would show is in ``elements``."""

    def __init__(self, url: str, identity: str | None = None, search: str = "", *, dark: bool = False) -> None:
        self._socket: ClientConnection = connect(
            url.replace("http", "ws"), subprotocols=[f"viser-v{viser.__version__}"], max_size=None  # type: ignore[list-item]
        )  # fmt: skip
        self.identity = identity
        self.page = json.dumps({"search": search, "dark": dark})
        self._happened: list[dict[str, object]] = []
        self.told_page: list[dict[str, Any]] = []
        self.elements: dict[str, dict[str, Any]] = {}
        self._news = threading.Condition()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        self.send(_CAMERA)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._socket.close()

    def _read(self) -> None:
        try:
            for data in self._socket:
                assert isinstance(data, bytes)
                size = int.from_bytes(data[8:16], "little")
                content = zstandard.ZstdDecompressor().decompress(data[16 : 16 + size])
                with self._news:
                    for message in msgspec.msgpack.decode(content)["messages"]:
                        self._take(message)
                    self._news.notify_all()
        except ConnectionClosed:
            return

    def _take(self, message: dict[str, Any]) -> None:
        kind = message["type"]
        if kind == "LocalStorageGetItemRequestMessage":
            said = self.page if message["key"] == KEY else self.identity
            answer = {"value": said, "error": None, "request_uuid": message["request_uuid"]}
            self.send({"type": "LocalStorageGetItemResponseMessage", **answer})
        elif kind == "LocalStorageSetItemMessage" and message["key"].endswith(KEY):
            self.told_page.append(json.loads(message["value"]))
        elif kind == "LocalStorageSetItemMessage":
            self.identity = message["value"]
        elif kind == "GuiUpdateMessage":
            self.elements.get(message["uuid"], {}).update(message["updates"])
        elif kind == "GuiRemoveMessage":
            self.elements.pop(message["uuid"], None)
        elif kind.startswith("Gui") and "props" in message:
            known = {"type": kind, "value": message.get("value"), **message["props"]}
            self.elements[message["uuid"]] = known

    def send(self, message: dict[str, Any]) -> None:
        """Send one message."""
        self._socket.send(msgspec.msgpack.encode(message))

    def garbage(self, data: bytes) -> None:
        """Send what no page would send."""
        self._socket.send(data)

    def until(self, holds: Callable[[], object]) -> object:
        """What ``holds`` gives as soon as it gives something."""
        due = time.monotonic() + WAIT
        with self._news:
            while not (found := holds()):
                left = due - time.monotonic()
                if left <= 0:
                    raise TimeoutError(f"not seen; the page says: {self.said()}")
                self._news.wait(left)
            return found

    def find(self, label: str) -> str:
        """The element of that label that came last."""

        def found() -> str | None:
            names = [uuid for uuid, each in self.elements.items() if each.get("label") == label]
            return names[-1] if names else None

        return str(self.until(found))

    def put(self, label: str, value: object) -> None:
        """Type, choose, or press."""
        uuid = self.find(label)
        self.elements[uuid]["value"] = value
        self.send({"type": "GuiUpdateMessage", "uuid": uuid, "updates": {"value": value}})

    def happens(self, **event: object) -> None:
        """Tell the server what the page's script would."""
        self._happened.append({**event, "number": len(self._happened) + 1})
        self.put(EVENT, json.dumps(self._happened[-8:]))

    def press(self, label: str) -> None:
        """Press a button once it is visible."""
        self.until(lambda: self.elements[self.find(label)].get("visible", True))
        self.put(label, True)

    def said(self) -> str:
        """The message at the top."""
        texts = [each["content"] for each in self.elements.values() if 'role="status"' in str(each.get("content"))]
        return texts[0] if texts else ""

    def told(self, words: str) -> None:
        """Wait until the message at the top has some words."""
        self.until(lambda: words in self.said())

    def shows(self, words: str) -> None:
        """Wait until some element has some words."""
        self.until(lambda: any(words in str(each.get("content")) for each in self.elements.values()))
