"""The names in a YAML file of a domain, and the keys that fit at a place."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias, TypeVar, get_args, get_origin

import yaml
from pydantic import BaseModel

from tmd.diagnostics import Location, TmdError
from tmd.editor.names import NameKind, Occurrence, Role, names_in_conditions
from tmd.yaml_nodes import compose

T = TypeVar("T")
# Keys from the root of a file; the items of a list have the path of the list.
KeyPath: TypeAlias = tuple[str, ...]
_WORD = re.compile(r"[a-z][a-z0-9_-]*")
_THING = (NameKind.TYPE, NameKind.OBJECT)
# The meaning of the keys of a mapping, by the end of its path; a star is any key.
_KEYS: Mapping[KeyPath, tuple[NameKind, Role]] = {
    ("classes",): (NameKind.TYPE, Role.DECLARED),
    ("substances",): (NameKind.OBJECT, Role.DECLARED),
    ("objects",): (NameKind.OBJECT, Role.DECLARED),
    ("objects", "*", "parts", "*"): (NameKind.PREDICATE, Role.HOLDS),
    ("states",): (NameKind.PREDICATE, Role.HOLDS),
    ("skills",): (NameKind.ACTION, Role.USED),
    **dict.fromkeys([("seen",), ("confirmed",), ("inferred",)], (NameKind.PREDICATE, Role.USED)),
}
# The kinds of the words of a scalar; the last is that of all that follow.
_VALUES: Mapping[KeyPath, tuple[tuple[NameKind, ...], ...]] = {
    ("inferred", "*", "to"): ((NameKind.PREDICATE,), ()),
    ("class",): ((NameKind.TYPE,), ()),
    ("parent",): ((NameKind.TYPE,), ()),
    ("substances", "*"): ((NameKind.TYPE,), ()),
    ("states", "*"): ((NameKind.OBJECT,), ()),
    ("objects", "*", "parts", "*", "*"): ((NameKind.OBJECT,), ()),
    ("objects", "*", "at"): ((NameKind.OBJECT,),),
    ("facts",): ((NameKind.PREDICATE,), (NameKind.OBJECT,)),
    ("init",): ((NameKind.PREDICATE,), (NameKind.OBJECT,)),
    **dict.fromkeys([("derived",), ("signs",), ("contents",)], ((NameKind.PREDICATE,), ())),
    ("edges",): ((), (NameKind.PREDICATE,), (NameKind.OBJECT,)),
    ("nouns", "*"): (_THING, ()),
    ("groups", "*"): (_THING, ()),
}


def names_in_yaml(text: str, file: str) -> list[Occurrence]:
    """Return the names of types, objects, predicates and actions, those of PDDL conditions included."""
    try:
        root = compose(text, file)
    except TmdError:
        return []
    found: list[Occurrence] = []
    conditions: list[tuple[int, int]] = []
    for path, node, value in _scalars(root, ()):
        begin, end = node.start_mark.index, node.end_mark.index
        if value is None and "(" in node.value:
            conditions.append((begin, end))
            continue
        for number, word in enumerate(_WORD.finditer(text, begin, end)):
            row = node.start_mark.line + 1 + text.count("\n", begin, word.start())
            column = word.start() - text.rfind("\n", 0, word.start())
            types = _class_in(value) if number == 0 else ()
            found += [
                Occurrence(word[0], kind, role, Location(file, row, column), path[0] if path else "", types)
                for kind, role in _meanings(path, number, is_key=value is not None)
            ]
    return found + names_in_conditions(_only(text, conditions), file)


def _scalars(node: yaml.Node | None, path: KeyPath) -> Iterator[tuple[KeyPath, yaml.ScalarNode, yaml.Node | None]]:
    """Yield each key with the path of its mapping and its value, and each other scalar with its path."""
    if isinstance(node, yaml.ScalarNode):
        yield path, node, None
    elif isinstance(node, yaml.SequenceNode):
        for child in node.value:
            yield from _scalars(child, path)
    elif isinstance(node, yaml.MappingNode) and "shape" not in path:
        for key, value in node.value:
            yield path, key, value
            yield from _scalars(value, (*path, key.value))


def _meanings(path: KeyPath, number: int, *, is_key: bool) -> list[tuple[NameKind, Role]]:
    if is_key:
        meaning = lookup(_KEYS, path)
        return [meaning] if meaning and number == 0 else []
    kinds = lookup(_VALUES, path) or ((),)
    return [(k, Role.HOLDS if k is NameKind.PREDICATE else Role.USED) for k in kinds[min(number, len(kinds) - 1)]]


def lookup(table: Mapping[KeyPath, T], path: KeyPath) -> T | None:
    """Return the entry of ``table`` for the longest end of ``path``."""
    ends = (path[start:] for start in range(len(path)))
    tried = ((pattern, end) for end in ends for pattern in table if len(pattern) == len(end))
    fitting = (p for p, end in tried if all(part in ("*", key) for part, key in zip(p, end, strict=True)))
    return table.get(next(fitting, ()))


def kinds_at(path: KeyPath, number: int, *, is_key: bool) -> list[NameKind]:
    """Return the kinds of declared names that may be word ``number`` of a key or value at ``path``."""
    return [kind for kind, role in _meanings(path, number, is_key=is_key) if role is not Role.DECLARED]


def _class_in(value: yaml.Node | None) -> tuple[str, ...]:
    """Return the class or parent that the value of a key gives."""
    if isinstance(value, yaml.ScalarNode):
        return (value.value,)
    entries = value.value if isinstance(value, yaml.MappingNode) else []
    return tuple(str(inner.value) for key, inner in entries if key.value in ("class", "parent"))


def _only(text: str, pieces: list[tuple[int, int]]) -> str:
    """Return the text with everything but some pieces blank, so that all places stay; quotes and bars are blank too."""
    kept, last = [], 0
    for begin, end in pieces:
        kept += [re.sub(r"[^\n]", " ", text[last:begin]), re.sub(r"[\"'|>;]", " ", text[begin:end])]
        last = end
    return "".join(kept)


def keys_in(file: Path, path: KeyPath) -> list[str]:
    """Return the keys that the model of a file has in the mapping at ``path``."""
    from tmd.world.classes import ObjectsFile
    from tmd.world.environment import Environment

    models: Mapping[str, object] = {"objects.yaml": ObjectsFile, "lexicon.yaml": None}
    fields = _fields(models.get(file.name, Environment))
    for part in path:
        fields = _fields(fields.get(part, fields.get("*")))
    return [name for name in fields if name != "*"]


def _fields(kind: object) -> dict[str, object]:
    """Return the types of the values of a mapping, by key (a star is any); of a list, of its items."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        return {field.alias or name: field.annotation for name, field in kind.model_fields.items()}
    if get_origin(kind) is dict:
        return {"*": get_args(kind)[1]}
    return {key: value for one in get_args(kind) for key, value in _fields(one).items()}


def path_at(lines: Sequence[str]) -> KeyPath:
    """Return the path of the mapping or value in which a text ends, from its indentation and open brackets."""
    *before, last = lines
    flow = re.sub(r"\{[^{}]*\}", "", last)
    opened = re.findall(r"([\w-]+):\s*\{", flow)
    key = re.search(r"([\w-]+):[^{},:]*$", flow)
    path = [*opened, key[1]] if key else opened
    indent = len(last) - len(last.lstrip(" "))
    for line in reversed(before):
        found = re.match(r"( *)(?:- )?([\w-]+):\s*(#.*)?$", line)
        if found and len(found[1]) < indent:
            indent = len(found[1])
            path.insert(0, found[2])
    return tuple(path)
