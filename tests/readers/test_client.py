"""The client: a server that fails, cuts, waits or lies gives one line, a documented exit code, and never the key."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from tests.cli.conftest import Ended, run_tmd
from tests.readers.conftest import Start, kit
from tests.readers.fake_server import Answer, asked, reply
from tmd.diagnostics import ExitCode, TmdError
from tmd.planning.processes import in_thread
from tmd.readers.llm.client import KEY, ModelClient, ModelError, ModelSettings
from tmd.readers.llm.reply import MOST_CHARACTERS, Reply, schema_of

SECRET = "sk-secret-1234567890"
TEXT = "Put the cup on the shelf."
GOAL = "(at cup1 shelf1 on)"
ASKED = [{"role": "user", "content": "Hello."}]


USUAL = ModelSettings("fake", key=SECRET, timeout=5)


def settings_for(url: str, usual: ModelSettings = USUAL) -> ModelSettings:
    return replace(usual, url=url)


def ground(tmp_path: Path, url: str | None, *more: str, **env: str) -> Ended:
    """Run the command as a user does, with a cache of its own."""
    where = ["--llm-url", url] if url is not None else []
    words = ["ground", "--environment", "corner1", "--domain", "02_table", "--text", TEXT, "--reader", "llm", *where]
    return run_tmd([*words, *more], tmp_path, env={"XDG_CACHE_HOME": str(tmp_path), KEY: SECRET, **env})


def one_line(ended: Ended, code: ExitCode, *words: str) -> None:
    assert ended.code == code, ended.err
    lines = [line for line in ended.err.splitlines() if not line.startswith("learning")]
    assert all(word in lines[0] for word in words), ended.err
    assert len([line for line in lines if not line.startswith("hint: ")]) == 1, ended.err
    assert "Traceback" not in ended.err and SECRET not in ended.err + ended.out


# ---------------------------------------------------------------------- failures of the server


FAILURES = {
    "401": (Answer(f"Incorrect API key provided: {SECRET}", 401), "refuses the key"),
    "404": (Answer("no such model", 404), "knows no model 'fake'"),
    "429": (Answer("slow down", 429, {"Retry-After": "0.01"}), "no room"),
    "a hostile delay": (Answer("slow down", 429, {"Retry-After": f"0 {SECRET} \x1b[31m"}), "(429)"),
    "500": (Answer(f"boom {SECRET}", 500), "status 500"),
    "nothing": (Answer(body=b"{}"), "empty answer"),
    "no JSON": (Answer(body=b"<html>hello</html>"), "no usable answer"),
    "another shape": (Answer(body=b'{"choices": [{"message": 3}]}'), "answer"),
    "an empty text": (Answer("  "), "empty answer"),
}


@pytest.mark.parametrize("name", FAILURES)
def test_a_failing_server_is_one_line(start: Start, name: str, tmp_path: Path) -> None:
    answer, words = FAILURES[name]
    ended = ground(tmp_path, start(lambda body: answer).url, "--llm-model", "fake")
    one_line(ended, ExitCode.MODEL_FAILED, words)
    assert ended.out == ""


def test_nobody_listens(tmp_path: Path) -> None:
    one_line(
        ground(tmp_path, "http://127.0.0.1:9/v1", "--llm-model", "fake"), ExitCode.MODEL_FAILED, "cannot be reached"
    )


@pytest.mark.parametrize(
    "url", ["http://x:abc", "http://[::1", "localhost:8000", "ftp://x/v1", "http://", "http://a b"]
)
def test_an_address_that_is_none(tmp_path: Path, url: str) -> None:
    ended = ground(tmp_path, url, "--llm-model", "fake")
    assert ended.code == ExitCode.MODEL_FAILED and "Traceback" not in ended.err and ended.err.count("error: ") == 1


def test_no_model(tmp_path: Path) -> None:
    one_line(ground(tmp_path, "http://127.0.0.1:9/v1"), ExitCode.MODEL_FAILED, "no language model is named")


def test_no_key(tmp_path: Path) -> None:
    ended = ground(tmp_path, None, "--llm-model", "fake", **{KEY: ""})
    one_line(ended, ExitCode.MODEL_FAILED, "no key")


def test_no_reply_in_time(start: Start) -> None:
    def late(body: Mapping[str, Any]) -> Answer:
        time.sleep(1)
        return Answer("late")

    client = ModelClient(settings_for(start(late).url, replace(USUAL, timeout=0.05)))
    with pytest.raises(ModelError, match="no reply within") as caught:
        client.complete(ASKED, "reading", {})
    assert caught.value.passing


def test_a_reply_that_drips_ends_in_time() -> None:
    with pytest.raises(TimeoutError):
        in_thread(partial(time.sleep, 60)).result(0.01)
    assert in_thread(lambda: 7).result(60) == 7


@pytest.mark.parametrize("key", [f"{SECRET}\r", f" {SECRET}\n"])
def test_white_space_round_a_key_does_not_count(start: Start, key: str) -> None:
    server = start(lambda body: Answer("fine"))
    ModelClient(settings_for(server.url, replace(USUAL, key=key))).complete(ASKED, "reading", {})
    assert server.keys == [f"Bearer {SECRET}"]


@pytest.mark.parametrize("changed", [{"key": "sk-\x00secret"}, {"key": "sk-\u00e9"}, {"url": f"http://me:{SECRET}@host/v1"},
                                     {"cache": "never"}, {"timeout": float("nan")}])  # fmt: skip
def test_settings_that_cannot_work_are_refused(changed: dict[str, Any]) -> None:
    with pytest.raises(TmdError) as caught:
        replace(USUAL, **changed).resolved()
    assert "secret" not in str(caught.value)


def test_options_of_the_model_are_for_the_model(tmp_path: Path) -> None:
    ended = run_tmd(["ground", "--environment", "corner1", "--text", TEXT, "--llm-model", "x"], tmp_path)
    assert ended.code == ExitCode.USAGE and "--llm-model is for --reader llm" in ended.err


# ---------------------------------------------------------------------- replies that cannot be used


REPLIES = {
    "prose": "Sure! I would put the cup on the shelf.",
    "cut": reply(TEXT, GOAL)[:-30],
    "a list": "[1, 2]",
    "half a character": "\ud800",
    "another shape": '{"goal": "(at cup1 shelf1 on)"}',
    "a number as goal": reply(TEXT, GOAL).replace(f'"{GOAL}"', "7"),
    "too long": "{" + " " * MOST_CHARACTERS,
    "ten megabytes": "a" * 10_000_000,
    "deep": '{"a":' * 5_000,
    "control characters": reply("Put the cup\x00\x1b[31m", GOAL),
    "fifty quantifiers": reply(TEXT, "(exists (?x - item) " * 50 + GOAL + ")" * 50),
    "another world": reply(TEXT, "(flies dragon1)"),
}


@pytest.mark.parametrize("name", REPLIES)
def test_a_reply_that_stays_useless_is_refused_in_one_line(start: Start, name: str, tmp_path: Path) -> None:
    server = start(lambda body: Answer(REPLIES[name]))
    ended = ground(tmp_path, server.url, "--llm-model", "fake")
    assert ended.code == ExitCode.NOT_GROUNDED, ended.err
    assert len([line for line in ended.err.splitlines() if line.startswith("no plan: ")]) == 1
    assert "plan 1" not in ended.out and SECRET not in ended.err + ended.out
    assert all(sign.isprintable() or sign == "\n" for sign in ended.err + ended.out)
    assert len(server.bodies) == 3


def test_json_in_a_fence_is_read(start: Start) -> None:
    server = start(lambda body: Answer(f"```json\n{reply(TEXT, GOAL)}\n```"))
    llm = settings_for(server.url, replace(USUAL, cache="off"))
    assert kit("02_table").ground(TEXT, "corner1", reader="llm", llm=llm).plans


# ---------------------------------------------------------------------- what is sent


def test_the_schema_suits_structured_output() -> None:
    """Every property is required and no others are allowed, as servers want it."""
    schema = schema_of(Reply)
    for part in (schema, *schema["$defs"].values()):
        if part["type"] == "object":
            assert part["additionalProperties"] is False
            assert set(part["required"]) == set(part["properties"])


@pytest.mark.parametrize("refused", ["response_format", "temperature", "seed"])
def test_a_parameter_that_a_server_refuses_is_left_out(start: Start, refused: str) -> None:
    def decide(body: Mapping[str, Any]) -> Answer:
        return Answer(f"Unsupported parameter: {refused}", 400) if refused in body else Answer("fine")

    server = start(decide)
    client = ModelClient(settings_for(server.url, replace(USUAL, cache="off")))
    assert [client.complete(ASKED, "reading", {})[0] for _ in range(2)] == ["fine", "fine"]
    assert [refused in body for body in server.bodies] == [True, False, False]
    assert set(server.keys) == {f"Bearer {SECRET}"}


def test_a_server_without_a_key_gets_none(start: Start) -> None:
    server = start(lambda body: Answer("fine"))
    ModelClient(settings_for(server.url, replace(USUAL, key=None))).complete(ASKED, "reading", {})
    assert server.keys == ["Bearer none"]


# ---------------------------------------------------------------------- the cache


def answered(start: Start) -> str:
    return start(lambda body: Answer(reply(asked(body)[1], GOAL))).url


def test_a_run_is_repeated_without_the_server(start: Start, tmp_path: Path) -> None:
    first = ground(tmp_path, answered(start), "--llm-model", "fake", "--json")
    again = ground(tmp_path, None, "--llm-model", "fake", "--llm-cache", "only", "--json")
    assert first.code == again.code == ExitCode.OK
    one, other = json.loads(first.out), json.loads(again.out)
    assert one["plans"] == other["plans"]
    assert one["reader"]["digests"] == other["reader"]["digests"]
    assert (one["reader"]["cached"], other["reader"]["cached"]) == (0, 1)
    kept = list((tmp_path / "tmd" / "llm").rglob("*.json"))
    assert [path.stem for path in kept] == one["reader"]["digests"]
    assert all(SECRET not in path.read_text() for path in kept)


def test_what_was_not_kept_is_reported(tmp_path: Path) -> None:
    ended = ground(tmp_path, None, "--llm-model", "fake", "--llm-cache", "only")
    one_line(ended, ExitCode.MODEL_FAILED, "no cached reply")


def test_another_model_or_prompt_is_asked_anew(start: Start) -> None:
    server = start(lambda body: Answer("fine"))
    for model, text in (("a", "x"), ("b", "x"), ("a", "y"), ("a", "x")):
        client = ModelClient(settings_for(server.url, replace(USUAL, model=model)))
        client.complete([{"role": "user", "content": text}], "reading", {})
    assert len(server.bodies) == 3


def test_a_damaged_file_of_the_cache_is_asked_anew(start: Start, tmp_path: Path) -> None:
    server = start(lambda body: Answer("fine"))
    client = ModelClient(settings_for(server.url))
    client.complete(ASKED, "reading", {})
    (path,) = (tmp_path / "llm").rglob("*.json")
    for damaged in ("", "{", "[]", '{"reply": 1}', '{"reply": "x", "prompt_tokens": Infinity, "completion_tokens": 1}'):
        path.write_text(damaged)
        assert client.complete(ASKED, "reading", {})[0] == "fine"
    assert len(server.bodies) == 6


def test_settings_do_not_show_the_key() -> None:
    assert SECRET not in repr(ModelSettings("m", key=SECRET))


# ---------------------------------------------------------------------- sentence tests


LINE = '{"id": "%s", "domain": "02_table", "environment": "corner1", "text": "%s", "goal": "%s", "kind": ["a"]}\n'


def cases(tmp_path: Path) -> Path:
    path = tmp_path / "my.sentences.jsonl"
    path.write_text(LINE % ("one", TEXT, GOAL) + LINE % ("two", "Hand me the cup.", "(holding pr2 cup1)"))
    return path


def test_a_failure_that_may_pass_does_not_end_the_other_tests(start: Start, tmp_path: Path) -> None:
    server = start(lambda body: Answer("busy", 500) if TEXT in str(body) else Answer(reply("Hand me the cup.", GOAL)))
    where = ["--llm-model", "fake", "--llm-url", server.url]
    alone = {"XDG_CACHE_HOME": str(tmp_path)}
    ended = run_tmd(["test", "--cases", cases(tmp_path), "--reader", "llm", *where], tmp_path, env=alone)
    assert ended.code == ExitCode.MODEL_FAILED
    assert "1 of 2 requests were not read" in ended.err
    assert any("Hand me the cup." in str(body) for body in server.bodies)


def test_a_question_has_its_exit_code_and_stands_in_the_json(start: Start, tmp_path: Path) -> None:
    options = [{"answer": "the cup", "goal": GOAL}, {"answer": "the book", "goal": "(at book1 shelf1 on)"}]
    question = {"text": "Which one?", "step": 0, "options": options}
    url = start(lambda body: Answer(reply(TEXT, GOAL, questions=[question]))).url
    ended = ground(tmp_path, url, "--llm-model", "fake", "--json")
    assert ended.code == ExitCode.QUESTION
    record = json.loads(ended.out)["question"]
    assert [option["answer"] for option in record["options"]] == ["the cup", "the book"]
    assert "question: Which one? 1. the cup (taken) 2. the book;" in ended.err
    words = ["ground", "--environment", "corner1", "--domain", "02_table", "--text", TEXT, "--reader", "llm", "--ask"]
    alone = {"XDG_CACHE_HOME": str(tmp_path)}
    answer = run_tmd([*words, "--llm-model", "fake", "--llm-url", url], tmp_path, stdin=b"2\n", env=alone)
    assert answer.code == ExitCode.OK and "(at book1 shelf1 on)" in answer.out
