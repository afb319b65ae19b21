"""Laying out YAML: indentation, spaces and blank lines; comments and the author's own line breaks stay.

Works on the token stream of PyYAML: only white space between tokens is changed, and the result is used only if it
says the same as before. Two columns for each level; one space between tokens; none inside brackets.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import yaml

from tmd.diagnostics import Location, TmdError
from tmd.pddl.reading.syntax import split_lines
from tmd.yaml_nodes import look_over

# Longer texts are refused: what says where comments stand reads some 100,000 characters a second.
MAX_CHARACTERS = 1_000_000
_OPENING = (yaml.FlowMappingStartToken, yaml.FlowSequenceStartToken)
_CLOSING = (yaml.FlowMappingEndToken, yaml.FlowSequenceEndToken)
_BLOCKS = (yaml.BlockMappingStartToken, yaml.BlockSequenceStartToken)
_SILENT = (*_BLOCKS, yaml.BlockEndToken, yaml.KeyToken, yaml.StreamStartToken, yaml.StreamEndToken)


@dataclass(slots=True)
class _Line:
    """Tokens of one line, and its old and new indentation."""

    tokens: list[yaml.Token] = field(default_factory=list)
    indent: int | None = None
    # It holds a piece of a scalar of several lines, and only moves as a whole.
    whole: bool = False


def format_yaml(text: str, file: str = "<text>") -> str:
    """Return ``text`` laid out; the same data and comments in the same order.

    Raises:
        TmdError: It is not YAML, or it is too large or too deep.
    """
    if len(text) > MAX_CHARACTERS:
        message = f"{file}: larger than {MAX_CHARACTERS // 1_000_000} MB"
        raise TmdError(message, hint="larger files are not laid out", code="too-large")
    look_over(text, file)
    lines = [line.rstrip() for line in split_lines(text)]
    clean = "\n".join(lines).strip("\n") + "\n"
    if clean == "\n":
        return ""
    try:
        before = _events(clean)
        if before != _events("\n".join(split_lines(text))):
            return text
        laid = _laid_out(clean)
        return laid if _events(laid) == before else clean
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = Location(file, mark.line + 1, mark.column + 1) if mark else Location(file, 1, 1)
        raise TmdError(f"not YAML: {error.problem}", location=place, code="yaml-syntax") from None
    except (yaml.YAMLError, RecursionError) as error:
        raise TmdError(f"not YAML: {error}", location=Location(file, 1, 1), code="yaml-syntax") from None


def _events(text: str) -> list[tuple[str, str]]:
    """Return the YAML events of ``text`` without their places."""
    found = []
    for event in yaml.parse(text, Loader=yaml.SafeLoader):
        said = (getattr(event, "value", ""), getattr(event, "tag", ""), getattr(event, "anchor", ""))
        found.append((type(event).__name__, repr(said)))
    return found


def _laid_out(text: str) -> str:
    source = text.split("\n")[:-1]
    lines = _tokens_by_line(text, len(source))
    shifts = _shifts(source, lines)
    out: list[str] = []
    for number, (line, raw) in enumerate(zip(lines, source, strict=True)):
        if not raw and (not out or not out[-1]) and not line.whole:
            continue
        out.append(_rebuilt(line, raw, shifts[number]) if raw else "")
    return "\n".join(out) + "\n"


def _tokens_by_line(text: str, count: int) -> list[_Line]:
    lines = [_Line() for _ in range(count + 1)]
    columns: list[tuple[int, int]] = []
    flow = 0
    for token in yaml.scan(text, Loader=yaml.SafeLoader):
        start, end = token.start_mark, token.end_mark
        if isinstance(token, _BLOCKS):
            columns.append((start.column, columns[-1][1] + 2 if columns else 0))
        elif isinstance(token, yaml.BlockEndToken):
            columns.pop()
        if isinstance(token, _SILENT):
            continue
        here = lines[start.line]
        if not here.tokens and not flow and columns and start.column == columns[-1][0]:
            here.indent = columns[-1][1]
        here.tokens.append(token)
        flow += isinstance(token, _OPENING) - isinstance(token, _CLOSING)
        if end.line > start.line:
            last = end.line if end.column else end.line - 1
            for number in range(start.line, last + 1):
                lines[number].whole = True
    return lines[:count]


def _shifts(source: list[str], lines: list[_Line]) -> list[int]:
    """Return the shift of each line: to its level, with the line before it, or, for comments, with the next one."""
    shifts: list[int] = []
    current = 0
    for line, raw in zip(lines, source, strict=True):
        if line.indent is not None:
            current = line.indent - (len(raw) - len(raw.lstrip(" ")))
        shifts.append(current)
    for number in range(len(source) - 2, -1, -1):
        if source[number].lstrip().startswith("#") and not lines[number].tokens and not lines[number].whole:
            indent = len(source[number]) - len(source[number].lstrip(" "))
            after = next((n for n in range(number + 1, len(source)) if source[n]), number)
            if indent == len(source[after]) - len(source[after].lstrip(" ")):
                shifts[number] = shifts[after]
    return shifts


def _rebuilt(line: _Line, raw: str, shift: int) -> str:
    indent = max(0, len(raw) - len(raw.lstrip(" ")) + shift)
    if line.whole or not line.tokens:
        return " " * indent + raw.lstrip(" ")
    code = ""
    before: yaml.Token | None = None
    for token in line.tokens:
        code += _space(before, token) + raw[token.start_mark.column : token.end_mark.column]
        before = token
    end = line.tokens[-1].end_mark.column
    comment = raw[end:].lstrip(" ")
    code = " " * indent + code
    if not comment:
        return code
    column = max(raw.index(comment, end) + shift, len(code) + 1)
    return code + " " * (column - len(code)) + comment


def _space(before: yaml.Token | None, token: yaml.Token) -> str:
    if before is None or isinstance(before, _OPENING) or isinstance(token, (*_CLOSING, yaml.FlowEntryToken)):
        return ""
    if isinstance(token, yaml.ValueToken):
        return ""
    return " "
