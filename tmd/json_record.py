"""Common parts of all JSON formats: the same classes write and read them, and a fault is reported in one line."""

from __future__ import annotations

import json
from typing import Any, ClassVar, Self

from pydantic import BaseModel, ConfigDict, ValidationError

from tmd.diagnostics import Location, TmdError

DIGITS = 6
"""Energies and factors are rounded to this many decimals, so that the last bits of a sum do not show."""


class JsonRecord(BaseModel):
    """Part of a JSON format.

    A key with a default is left out where there is nothing to say, or where a file is older than the key; every other
    key is always there. There are no other keys. Keys stand in the order of the fields.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    WHAT: ClassVar[str] = "a record of tmd"
    """What a whole file, or a line of it, is: *a prediction of tmd experiment*."""
    REMAKE: ClassVar[str] = "make it again"
    """What to do about one of another version."""
    REPAIR: ClassVar[str] = ""
    """What to do about one that is damaged; the same if empty."""

    def to_value(self) -> dict[str, Any]:
        """The record as JSON holds it."""
        return self.model_dump(mode="json", exclude_unset=True)

    def given(self) -> dict[str, Any]:
        """The fields that have something to say, as they are: what :meth:`to_value` shows."""
        return {name: value for name, value in self if name in self.model_fields_set}

    def to_line(self) -> str:
        """The record as a line of JSON Lines."""
        return json.dumps(self.to_value(), ensure_ascii=False) + "\n"

    @classmethod
    def from_value(cls, value: object, file: str, line: int | None = None) -> Self:
        """The record in a JSON value.

        Args:
            value: What was read.
            file: Its file, for messages.
            line: Its line, where the file is JSON Lines.

        Raises:
            TmdError: A key is missing, unknown or of the wrong kind: which, what is expected and what to do.
        """
        try:
            return cls.model_validate(value)
        except ValidationError as error:
            raise cls._fault(error, file, line) from None

    @classmethod
    def from_text(cls, text: str, file: str, line: int | None = None) -> Self:
        """The record in a text, as :meth:`from_value`.

        Raises:
            TmdError: It is not JSON, or not this record.
        """
        return cls.from_value(json_value(text, file, line, cls.REPAIR or cls.REMAKE), file, line)

    @classmethod
    def from_lines(cls, text: str, file: str) -> list[Self]:
        """The records of a JSON Lines file; blank lines are passed over.

        Raises:
            TmdError: A line is not JSON, or not this record; with its place.
        """
        # not splitlines(): what people wrote may hold other ends of lines than \n
        return [cls.from_text(line, file, n) for n, line in enumerate(text.split("\n"), 1) if line.strip()]

    @classmethod
    def _fault(cls, error: ValidationError, file: str, line: int | None) -> TmdError:
        """The first thing that is wrong."""
        first = error.errors(include_url=False, include_input=False)[0]
        version = {"missing": "an older", "extra_forbidden": "another"}.get(first["type"])
        hint = f"it was written by {version} version of tmd: {cls.REMAKE}" if version else cls.REPAIR or cls.REMAKE
        place = ".".join(map(str, first["loc"]))
        told = f"not {cls.WHAT}: {f'{place}: ' if place else ''}{_expectation(first['type'], first['msg'])}"
        if line is None:
            return TmdError(f"{file} is {told}", hint=hint)
        return TmdError(f"this is {told}", location=Location(file, line, 1), hint=hint)


_EXPECTATIONS = {
    "missing": "the key is missing",
    "extra_forbidden": "there is no such key",
    "model_type": "should be a JSON object",
}


def _expectation(kind: str, message: str) -> str:
    plain = " ".join(message.removeprefix("Value error, ").split())
    return _EXPECTATIONS.get(kind) or plain.replace("Input should", "should").replace("valid tuple", "list")


def json_value(text: str, file: str, line: int | None = None, hint: str | None = None) -> Any:  # noqa: ANN401 - any
    """The JSON value in a text.

    Args:
        text: The text.
        file: Its file, for messages.
        line: Its line, where the file is JSON Lines.
        hint: What to do if it is not JSON.

    Raises:
        TmdError: It is not JSON; with its place.
    """
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        place = Location(file, line or error.lineno, error.colno)
        raise TmdError(f"this is not valid JSON: {error.msg}", location=place, hint=hint) from None
    except (ValueError, RecursionError):
        place = Location(file, line or 1, 1)
        raise TmdError("this is JSON with too many levels or digits", location=place, hint=hint) from None


def rounded(value: float) -> float:
    """A number as it is printed; there is no negative zero."""
    return round(value, DIGITS) + 0.0
