"""An OpenAI-compatible server, and the cache of its replies.

Nothing of the key is ever written or printed: messages of the server are scrubbed.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast, get_args

from pydantic import BaseModel

from tmd.diagnostics import ExitCode, MissingToolError, OptionError, OutputError, TmdError, install_extra, one_line
from tmd.files import cache_directory, make_directory, read_bytes, write_bytes
from tmd.planning.processes import in_thread
from tmd.readers.interface import Usage

if TYPE_CHECKING:
    from openai import OpenAI

Messages: TypeAlias = Sequence[Mapping[str, str]]
CacheMode: TypeAlias = Literal["on", "off", "only"]
# The environment variables for key, address and model.
KEY, URL, MODEL = "OPENAI_API_KEY", "OPENAI_BASE_URL", "OPENAI_MODEL"
# The key that is sent to servers that need none.
_NO_KEY = "none"
_RETRIES = 2
# The longest time-out, in seconds.
LONGEST = 86_400.0
_ADDRESS = re.compile(r"https?://(\[[\da-f:]+\]|[\w.-]+)(:\d{1,5})?(/[!-~]*)?", re.ASCII | re.IGNORECASE)
_SECRET = re.compile(r"[!-~]+")
_WAIT = re.compile(r"\d{1,6}")
# Parameters that some models refuse; a request is repeated without them.
_MAY_BE_REFUSED = ("response_format", "seed", "temperature")


class ModelError(TmdError):
    """The language model cannot be asked, or gives no answer.

    ``passing`` says whether another request, or the same one later, may well be answered.
    """

    exit_code = ExitCode.MODEL_FAILED

    def __init__(self, message: str, *, hint: str | None = None, passing: bool = False) -> None:
        super().__init__(message, hint=hint)
        self.passing = passing

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(ModelError, hint=self.hint, passing=self.passing), (self.message,)


@dataclass(frozen=True, slots=True)
class ModelSettings:
    """The connection to a language model.

    Attributes:
        model: The name of the model; ``$OPENAI_MODEL`` by default.
        url: The address of the server, such as ``http://localhost:8000/v1``; ``$OPENAI_BASE_URL``, or else OpenAI's, by
            default.
        key: The key; ``$OPENAI_API_KEY`` by default. Servers with an address of their own may need none.
        cache: ``on`` keeps replies and uses them again, ``only`` never asks the server, ``off`` always does.
        timeout: Seconds to wait for a reply.
    """

    model: str | None = None
    url: str | None = None
    key: str | None = field(default=None, repr=False)
    cache: CacheMode = "on"
    timeout: float = 600.0
    seed: int = 0

    def resolved(self) -> ModelSettings:
        """Return the settings with what the environment variables add.

        Raises:
            ModelError: There is no model, or no key for a server that needs one.
            OptionError: A setting has no such value.
        """
        if self.cache not in get_args(CacheMode):
            raise OptionError(f"there is no cache mode '{self.cache}'", hint=", ".join(get_args(CacheMode)))
        if not 0 < self.timeout <= LONGEST:
            raise OptionError(
                f"a time-out of {self.timeout:g} s cannot be kept", hint=f"more than 0, at most {LONGEST:g}"
            )
        model = self.model or os.environ.get(MODEL)
        url = self.url or os.environ.get(URL)
        key = (self.key or os.environ.get(KEY) or "").strip()
        if not model:
            raise ModelError("no language model is named", hint=f"name one, or set ${MODEL}")
        if url and not _ADDRESS.fullmatch(url):
            shown = re.sub("//.*@", "//", url)[:200]
            hint = f"such as http://localhost:8000/v1, without a password: the key is in ${KEY}"
            raise ModelError(f"'{shown}' is not the address of a server", hint=hint)
        if key and not _SECRET.fullmatch(key):
            raise ModelError("the key has characters that no key has", hint=f"check ${KEY}")
        if not key and not url and self.cache != "only":
            raise ModelError("there is no key for the language model", hint=f"set ${KEY}, or name another server")
        return ModelSettings(model, url, key or _NO_KEY, self.cache, self.timeout, self.seed)


class _Kept(BaseModel):
    """A reply as the cache keeps it."""

    model: str
    reply: str
    prompt_tokens: int
    completion_tokens: int


class ModelClient:
    """A client of a language model.

    Environment variables fill in what is missing in ``settings``.

    Raises:
        ModelError: There is no model, or no key for a server that needs one.
    """

    def __init__(self, settings: ModelSettings) -> None:
        self.settings = settings.resolved()
        self._refused: set[str] = set()
        self._client: OpenAI | None = None

    @property
    def model(self) -> str:
        """The name of the model."""
        return self.settings.model or ""

    def complete(self, messages: Messages, name: str, schema: Mapping[str, Any]) -> tuple[str, Usage]:
        """Return the reply to ``messages``, which should follow ``schema``, and the effort that it took.

        Raises:
            ModelError: The server cannot be reached, refuses, or sends no text; or there is no cached reply where only
                such are wanted.
            MissingToolError: The package ``openai`` is not installed.
        """
        asked = {"model": self.model, "messages": list(messages), "schema": schema}
        digest = hashlib.sha256(json.dumps(asked, sort_keys=True, ensure_ascii=False).encode()).hexdigest()
        usage = Usage(self.model, digests=(digest,))
        folder = None if self.settings.cache == "off" else cache_directory("llm")
        path = None if folder is None else folder / digest[:2] / f"{digest}.json"
        if path is not None and (kept := _recall(path)) is not None:
            sent, received = kept.prompt_tokens, kept.completion_tokens
            return _encodable(kept.reply), replace(usage, prompt_tokens=sent, completion_tokens=received, cached=1)
        if self.settings.cache == "only":
            message = f"the model '{self.model}' has no cached reply to this request ({digest[:12]})"
            raise ModelError(message, hint="run once without --llm-cache only")
        began = time.monotonic()
        text, (sent, received) = self._ask(messages, name, schema)
        seconds = round(time.monotonic() - began, 3)
        if path is not None:
            _keep(path, _Kept(model=self.model, reply=text, prompt_tokens=sent, completion_tokens=received))
        return text, replace(usage, prompt_tokens=sent, completion_tokens=received, seconds=seconds)

    def _ask(self, messages: Messages, name: str, schema: Mapping[str, Any]) -> tuple[str, tuple[int, int]]:
        if find_spec("openai") is None:
            raise MissingToolError("the package openai is not installed", hint=install_extra("llm"))
        import openai

        own = self.settings
        form = {"type": "json_schema", "json_schema": {"name": name, "strict": True, "schema": schema}}
        given: dict[str, Any] = {"temperature": 0, "seed": own.seed, "response_format": form}
        while True:
            options = {key: value for key, value in given.items() if key not in self._refused}
            try:
                if self._client is None:
                    self._client = openai.OpenAI(
                        api_key=own.key, base_url=own.url, timeout=own.timeout, max_retries=_RETRIES
                    )
                said = cast(Any, list(messages))
                create = partial(self._client.chat.completions.create, model=self.model, messages=said, **options)
                # a server that sends a byte now and then never exceeds the client's own limits
                answer = in_thread(create).result((_RETRIES + 1) * own.timeout)
                break
            except openai.APIStatusError as error:
                refused = _refused_parameter(error.status_code, str(error), options)
                if refused is None:
                    raise self._status_error(error.status_code, str(error), error.response.headers) from None
                self._refused.add(refused)
            except (openai.APITimeoutError, TimeoutError):
                message = f"no reply within {own.timeout:g} s from {self._place()}"
                raise ModelError(message, hint="try again later, or allow more time", passing=True) from None
            except openai.APIConnectionError as error:
                message = f"{self._place()} cannot be reached: {self._scrubbed(str(error.__cause__ or error))}"
                raise ModelError(message, hint="check the address of the server") from None
            except Exception as error:  # addresses that no parser takes, bodies of any shape: whatever a client raises
                raise ModelError(f"{self._place()} sent no usable answer: {self._scrubbed(str(error))}") from None
        return self._text_of(answer)

    def _text_of(self, answer: Any) -> tuple[str, tuple[int, int]]:  # noqa: ANN401 - servers send anything
        """Return the reply, and the numbers of tokens that were sent and received."""
        try:
            choice = answer.choices[0]
            text = choice.message.content or getattr(choice.message, "refusal", None) or ""
        except (AttributeError, IndexError, TypeError):
            text = None
        if not isinstance(text, str) or not text.strip():
            raise ModelError(f"{self._place()} sent an empty answer", hint="check that the model is a chat model")
        used = getattr(answer, "usage", None)
        counts = (getattr(used, name, 0) or 0 for name in ("prompt_tokens", "completion_tokens"))
        sent, received = (count if isinstance(count, int) else 0 for count in counts)
        return _encodable(text), (sent, received)

    def _status_error(self, status: int, message: str, headers: Mapping[str, str]) -> ModelError:
        place, wait = self._place(), headers.get("retry-after", "")
        again = f"; it asks to wait {wait} s" if _WAIT.fullmatch(wait) else ""
        key = ("wants a key", f"set ${KEY}") if self.settings.key == _NO_KEY else ("refuses the key", f"check ${KEY}")
        model = f"knows no model '{self.model}' (404)", "check the name of the model and the address of the server"
        other = f"answers with status {status}: {self._scrubbed(message)}", "look at the server's log"
        known = {
            401: (f"{key[0]} (401)", key[1]),
            404: model,
            429: (f"has no room for this request now (429){again}", "try again later"),
        }
        problem, hint = known.get(status, other)
        passing = status == 429 or status >= 500
        return ModelError(f"{place} {problem}", hint=hint if status in known or passing else None, passing=passing)

    def _place(self) -> str:
        return self.settings.url or "the OpenAI server"

    def _scrubbed(self, text: str) -> str:
        """Return a message on one line, without the key."""
        key = self.settings.key or ""
        line = one_line(text)
        return (line.replace(key, "***") if len(key) > 4 else line)[:300]


def _encodable(text: str) -> str:
    """Return a text without lone surrogates, which JSON may contain and UTF-8 may not."""
    return text.encode("utf-8", "replace").decode()


def _refused_parameter(status: int, message: str, options: Mapping[str, Any]) -> str | None:
    """Return the parameter that a server refuses, to be left out; ``None`` where that is not the reason."""
    if status not in (400, 422):
        return None
    said = message.lower()
    named = next((name for name in _MAY_BE_REFUSED if name in options and name in said), None)
    schema = "response_format" if "response_format" in options and ("schema" in said or "format" in said) else None
    return named or schema


def _recall(path: Path) -> _Kept | None:
    """Return a reply of the cache; ``None`` where there is none, or it is damaged."""
    try:
        return _Kept.model_validate_json(read_bytes(path))
    except (OSError, ValueError):
        return None


def _keep(path: Path, reply: _Kept) -> None:
    # a cache that cannot be written costs the next run a question
    with suppress(OutputError):
        make_directory(path.parent)
        write_bytes(path, (reply.model_dump_json(indent=1) + "\n").encode())
