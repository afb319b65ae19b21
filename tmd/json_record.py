"""Common parts of all JSON formats: the same classes write and read them, and a fault is reported in one line."""

from __future__ import annotations

import json
from typing import Annotated, Any, ClassVar, Self

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, ValidationError
from pydantic_core import ErrorDetails

from tmd.diagnostics import Location, TmdError
from tmd.short_repr import short_repr

# Energies and factors are rounded to this many decimals, so that the last bits of a sum do not show.
DIGITS = 6


@short_repr(lambda record: " ".join(f"{name}={value!r}" for name, value in record))
class JsonRecord(BaseModel):
    """Part of a JSON format.

    A key with a default is left out where there is nothing to say, or where a file is older than the key; every other
    key is always there. There are no other keys. Keys have the order of the fields.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    # The name of a whole file, or of a line of it: *a prediction of tmd experiment*.
    WHAT: ClassVar[str] = "a record of tmd"
    # The hint for one of another version; empty where people write it.
    REMAKE: ClassVar[str] = "make it again"
    # The hint for one that is damaged; the same if empty.
    REPAIR: ClassVar[str] = ""

    def to_value(self) -> dict[str, Any]:
        """Return the record as JSON holds it."""
        return self.model_dump(mode="json", exclude_unset=True)

    @classmethod
    def copied(cls, source: object, **others: Any) -> Self:  # noqa: ANN401 - fields
        """Return a record whose fields are the attributes of ``source`` of the same names, but for ``others``.

        Attributes with the default of their field are left out.
        """
        found = {name: getattr(source, name) for name in cls.model_fields if hasattr(source, name)}
        own = {name: value for name, value in found.items() if value != cls.model_fields[name].default}
        return cls.model_validate({**own, **others})

    def given(self) -> dict[str, Any]:
        """Return the fields that :meth:`to_value` shows, as they are."""
        return {name: value for name, value in self if name in self.model_fields_set}

    def to_line(self) -> str:
        """Return the record as a line of JSON Lines."""
        return json.dumps(self.to_value(), ensure_ascii=False) + "\n"

    @classmethod
    def from_value(cls, value: object, file: str, line: int | None = None) -> Self:
        """Return the record in a JSON value.

        ``file`` and, of JSON Lines, ``line`` are for messages.

        Raises:
            TmdError: A key is missing, unknown or of the wrong kind.
        """
        try:
            return cls.model_validate(value)
        except ValidationError as error:
            raise cls._fault(error, file, line) from None

    @classmethod
    def from_text(cls, text: str, file: str, line: int | None = None) -> Self:
        """Return the record in a text, as :meth:`from_value`.

        Raises:
            TmdError: It is not JSON, or not this record.
        """
        return cls.from_value(json_value(text, file, line, cls.REPAIR or cls.REMAKE), file, line)

    @classmethod
    def from_lines(cls, text: str, file: str) -> list[Self]:
        """Return the records of a JSON Lines file; blank lines are skipped.

        Raises:
            TmdError: A line is not JSON, or not this record; with its place.
        """
        # not splitlines(): what people wrote may hold other ends of lines than \n
        return [cls.from_text(line, file, n) for n, line in enumerate(text.split("\n"), 1) if line.strip()]

    @classmethod
    def _fault(cls, error: ValidationError, file: str, line: int | None) -> TmdError:
        """Return the first fault."""
        first = error.errors(include_url=False, include_input=False)[0]
        version = {"missing": "an older", "extra_forbidden": "another"}.get(first["type"])
        hint = cls.REPAIR or cls.REMAKE
        if version and cls.REMAKE:
            hint = f"it was written by {version} version of tmd: {cls.REMAKE}"
        place = ".".join(map(str, first["loc"]))
        fault = f"not {cls.WHAT}: {f'{place}: ' if place else ''}{expectation(first, 'a JSON object')}"
        if line is None:
            return TmdError(f"{file} is {fault}", hint=hint)
        return TmdError(f"this is {fault}", location=Location(file, line, 1), hint=hint)


_EXPECTATIONS = {
    "missing": "the key is missing",
    "extra_forbidden": "there is no such key",
    "string_type": "should be text",
    "list_type": "should be a list",
    "tuple_type": "should be a list",
}
_MAPPINGS = frozenset({"dict_type", "mapping_type", "model_type", "model_attributes_type"})


def expectation(fault: ErrorDetails, mapping: str) -> str:
    """Return the fault that pydantic found in a value, in words of the file format instead of Python's."""
    if fault["type"] in _MAPPINGS:
        return f"should be {mapping}"
    plain = " ".join(fault["msg"].removeprefix("Value error, ").split()).replace("valid tuple", "list")
    plain = plain.replace("Input should", "should").replace("String should", "should")
    return _EXPECTATIONS.get(fault["type"], plain)


def json_value(text: str, file: str, line: int | None = None, hint: str | None = None) -> Any:  # noqa: ANN401 - any
    """Return the JSON value in a text.

    ``file`` and, of JSON Lines, ``line`` are for messages; ``hint`` is what to do if it is not JSON.

    Raises:
        TmdError: It is not JSON; with its place.
    """
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        place, source = Location(file, line or error.lineno, error.colno), None if line is None else text
        message = f"this is not valid JSON: {error.msg}"
        raise TmdError(message, location=place, hint=hint, source=source, code="json-syntax") from None
    except (ValueError, RecursionError) as error:
        code = "nested-too-deeply" if isinstance(error, RecursionError) else "json-syntax"
        message = "this is JSON with too many levels or digits"
        raise TmdError(message, location=Location(file, line or 1, 1), hint=hint, code=code) from None


def rounded(value: float) -> float:
    """Return a number as it is printed; there is no negative zero."""
    return round(value, DIGITS) + 0.0


# A number as it is printed.
Rounded = Annotated[float, AfterValidator(rounded)]
# A text that is null where it is empty.
TextOrNull = Annotated[str | None, BeforeValidator(lambda text: text or None)]
