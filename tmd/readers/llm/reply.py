"""The reply of a language model: the classes that its JSON schema is generated from."""

from __future__ import annotations

import re
from enum import StrEnum
from functools import cache
from typing import Any, TypeVar

from pydantic import Field, ValidationError

from tmd.diagnostics import TmdError, one_line
from tmd.json_record import JsonRecord

# Longer replies are refused unread.
MOST_CHARACTERS = 200_000
_Record = TypeVar("_Record", bound=JsonRecord)
_FENCE = re.compile(r"^\s*```[\w-]*\n(.*?)\n?```\s*$", re.DOTALL)


class ReplyStep(JsonRecord):
    """One step: a condition to be brought about."""

    text: str = Field(description="The words of the request that this step covers, quoted exactly.")
    verb: str = Field(description="The verb in its base form, such as put or turn_on.")
    objects: list[str] = Field(description="The nouns of the step as the user said them, in order.")
    when: str | None = Field(description="A PDDL condition that guards the step; null where there is none.")
    otherwise: bool = Field(description="Whether the step is done exactly when the guard of the step before failed.")
    via: list[str] = Field(description="PDDL conditions that must hold on the way, one after the other.")
    goal: str = Field(description="The PDDL condition that must hold when the step is done.")


class ReplyConstraint(JsonRecord):
    """A prohibition or an exception, which holds throughout."""

    text: str = Field(description="The words of the request, quoted exactly.")
    never: str | None = Field(description="A PDDL condition that no action may bring about.")
    untouched: list[str] = Field(description="Objects that no action may handle.")


class ReplyRefusalKind(StrEnum):
    """Kinds of reasons to refuse a request."""

    MISSING = "missing"
    IMPOSSIBLE = "impossible"
    UNSAFE = "unsafe"
    NO_REQUEST = "no-request"
    NOT_UNDERSTOOD = "not-understood"


class ReplyRefusal(JsonRecord):
    """A request that must not or cannot be carried out."""

    kind: ReplyRefusalKind
    reason: str = Field(description="One short sentence to the user.")


class ReplyOption(JsonRecord):
    """One possible meaning of a step."""

    answer: str = Field(description="The answer in the user's words.")
    goal: str = Field(description="The goal of the step in that case.")


class ReplyQuestion(JsonRecord):
    """A question back to the user, where two meanings differ and nothing decides."""

    text: str
    step: int = Field(description="The number of the step that it is about, counted from 0.")
    options: list[ReplyOption] = Field(description="Two to four, the likeliest first.")


class Reply(JsonRecord):
    """The reading of a request."""

    thoughts: str = Field(description="What is asked, which objects are meant and why, in one to three sentences.")
    refusal: ReplyRefusal | None
    steps: list[ReplyStep]
    final: str | None = Field(description="All that must hold when everything is done, where no step's goal says it.")
    constraints: list[ReplyConstraint]
    questions: list[ReplyQuestion]


class Judgement(JsonRecord):
    """The model's verdict on a plan."""

    thoughts: str
    correct: bool = Field(description="Whether the changes are what was asked, and nothing that matters beside it.")
    reason: str = Field(description="What is wrong; empty where nothing is.")


@cache
def schema_of(record: type[JsonRecord]) -> dict[str, Any]:
    """Return the JSON schema of a reply, in the subset that servers accept for structured output."""
    schema = record.model_json_schema()
    for part in (schema, *schema.get("$defs", {}).values()):
        part.pop("title", None)
        for property_ in part.get("properties", {}).values():
            property_.pop("title", None)
    return schema


def parse_reply(record: type[_Record], text: str) -> _Record:
    """Parse a reply: JSON, or JSON in a fence of Markdown.

    Raises:
        TmdError: The reply is too long, not JSON, or JSON of another shape; the message is meant for the model.
    """
    if len(text) > MOST_CHARACTERS:
        raise TmdError(f"the reply has {len(text):,} characters, more than {MOST_CHARACTERS:,}")
    fenced = _FENCE.match(text)
    try:
        return record.model_validate_json((fenced[1] if fenced else text).strip())
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        message = one_line(first["msg"].removeprefix("Invalid JSON: "))[:200]
        if first["type"] == "json_invalid":
            raise TmdError(
                f"the reply is not valid JSON: {message}", hint="write one JSON object and nothing else"
            ) from None
        place = ".".join(map(str, first["loc"]))
        raise TmdError(f"the reply has another shape: {f'{place}: ' if place else ''}{message}") from None
