"""An OpenAI-compatible server on loopback whose replies a test decides: real HTTP, no model."""

from __future__ import annotations

import json
import re
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

_REQUEST = re.compile(r"<request>\n(.*)\n</request>", re.DOTALL)
_ENVIRONMENT = re.compile(r"^Environment (\S+)\.", re.MULTILINE)


@dataclass
class Answer:
    """What the server sends: a chat completion with ``text``, or ``body`` as it is."""

    text: str = ""
    status: int = 200
    headers: Mapping[str, str] = field(default_factory=dict)
    body: bytes | None = None
    finish: str = "stop"


Decide = Callable[[dict[str, Any]], Answer]
"""Decides the answer to the body of a request."""


@dataclass
class FakeServer:
    """A running server: its address, and the bodies and headers of all requests so far."""

    url: str
    bodies: list[dict[str, Any]] = field(default_factory=list)
    keys: list[str] = field(default_factory=list)


@contextmanager
def serve(decide: Decide) -> Iterator[FakeServer]:
    """Run a server until the block ends."""
    state = FakeServer("")

    class Handler(BaseHTTPRequestHandler):
        def log_message(self, *_: object) -> None:
            """Keep standard error quiet."""

        def do_POST(self) -> None:
            body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            state.bodies.append(body)
            state.keys.append(self.headers.get("Authorization", ""))
            answer = decide(body)
            data = answer.body if answer.body is not None else json.dumps(completion(answer)).encode()
            self.send_response(answer.status)
            for name, value in {"Content-Type": "application/json", **answer.headers}.items():
                self.send_header(name, value)
            self.send_header("Content-Length", str(len(data)))
            self.end_headers()
            self.wfile.write(data)

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    state.url = f"http://127.0.0.1:{server.server_port}/v1"
    thread = threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True)
    thread.start()
    try:
        yield state
    finally:
        server.shutdown()
        server.server_close()


def completion(answer: Answer) -> dict[str, Any]:
    if answer.status != 200:
        return {"error": {"message": answer.text or "rehearsed", "type": "rehearsed"}}
    message = {"role": "assistant", "content": answer.text}
    return {
        "id": "1",
        "object": "chat.completion",
        "created": 1,
        "model": "fake",
        "choices": [{"index": 0, "message": message, "finish_reason": answer.finish}],
        "usage": {"prompt_tokens": 1000, "completion_tokens": 100, "total_tokens": 1100},
    }


def asked(body: Mapping[str, Any]) -> tuple[str, str]:
    """Return the environment and the request that a prompt is about."""
    text = "\n".join(message["content"] for message in body["messages"] if message["role"] == "user")
    found, place = _REQUEST.search(text), _ENVIRONMENT.search(text)
    assert found is not None and place is not None
    return place[1], found[1]


def reply(request: str, goal: str | None, **changed: object) -> str:
    """Return a reply with one step for the whole request, or a refusal where there is no goal."""
    step = {
        "text": request, "verb": "do", "objects": [], "when": None, "otherwise": False, "via": [], "goal": goal
    }  # fmt: skip
    value: dict[str, Any] = {
        "thoughts": "The gold goal.",
        "refusal": {"kind": "impossible", "reason": "It cannot be done here."} if goal is None else None,
        "steps": [] if goal is None else [step],
        "final": None,
        "constraints": [],
        "questions": [],
    }
    return json.dumps({**value, **changed})


def gold(goals: Mapping[tuple[str, str], str | None]) -> Decide:
    """Answer each request with its gold goal, by environment and request."""

    def decide(body: dict[str, Any]) -> Answer:
        environment, request = asked(body)
        return Answer(reply(request, goals[environment, request]))

    return decide
