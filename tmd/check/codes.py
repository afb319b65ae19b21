"""The kinds of problems the checker knows. Names are stable: scripts and editors may rely on them."""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum


class Severity(StrEnum):
    """An error keeps ``tmd`` from using a file; a warning is worth a look; a note is for who wants to know more."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


_ERRORS = {
    # files
    "unreadable": "the file cannot be read",
    "not-text": "the file is binary",
    "not-utf8": "the file is not UTF-8",
    "too-large": "the file is larger than any file of tmd",
    "control-character": "a character that no text has",
    "look-alike": "a character that looks like another one",
    "outside-folder": "a name or link leads out of its folder",
    # form of PDDL
    "unclosed-parenthesis": "an opening parenthesis without its closing one",
    "extra-parenthesis": "a closing parenthesis too many",
    "nested-too-deeply": "more levels than anything meaningful has",
    "empty-file": "there is nothing in the file",
    "syntax": "something stands where something else is expected",
    "unknown-section": "a section that PDDL does not have",
    "unknown-keyword": "a part that actions do not have",
    "duplicate-section": "a section or part stands twice",
    "missing-section": "a problem without domain or goal",
    "bad-name": "a name of characters that names cannot have",
    "unknown-requirement": "a requirement that PDDL does not have",
    "not-supported": "PDDL that tmd does not support",
    "when-in-condition": '"when" in a condition',
    "not-an-effect": "a condition where an effect is expected",
    # YAML, JSON and what they say
    "yaml-syntax": "the file is not YAML",
    "yaml-tag": "a YAML tag",
    "yaml-alias": "a YAML alias",
    "duplicate-key": "a key that stands twice",
    "unknown-key": "a key that the file does not have",
    "bad-value": "a value of the wrong kind",
    "json-syntax": "the text is not JSON",
    "missing-file": "a file that another one needs is not there",
    "unknown-class": "a class that objects.yaml does not have",
    "class-cycle": "a class that is its own ancestor or part",
    "unknown-part": "a part that a class does not have",
    "unknown-state": "a state that an object does not have",
    "unknown-action": "an action that the domain does not have",
    "unknown-domain": "a domain that is not there",
    "unknown-base": "a base lexicon that is not there",
    "include-cycle": "a base lexicon that includes itself",
    "missing-skill": "an action without a skill",
    "missing-role": "a skill that is not told what it needs",
    "stale-domain": "a domain.pddl that is not what its sources compile to",
    "bad-goal": "a goal of a verb that is not of the form of one",
    "bad-row": "a phrase row that is not of the form of one",
    "bad-demonstration": "a line that is not a demonstration",
    "unknown-environment": "an environment that is not there",
    "not-executable": "a demonstration that cannot be executed",
    "no-room": "something that does not fit where it is said to stand",
    "overlap": "things that stand in each other",
    "goal-not-reached": "a goal that does not hold at the end of its demonstration",
    # meaning of PDDL
    "duplicate-name": "a name that is declared twice, up to case",
    "type-cycle": "a type that is its own ancestor",
    "unknown-type": "a type that is not declared",
    "unknown-predicate": "a predicate that is not declared",
    "unknown-function": "a function that is not declared",
    "unknown-object": "an object or constant that is not declared",
    "free-variable": "a variable that nothing declares",
    "wrong-arity": "too many or too few arguments",
    "wrong-type": "an argument of the wrong type",
    "wrongly-derived": "a derived predicate that is also made true or false, or follows from its own negation",
    "domain-mismatch": "a problem that names another domain",
    "contradictory-init": "an atom that holds and does not hold at the start",
}
_WARNINGS = {
    "missing-requirement": "something is used without its requirement",
    "unsupported-requirement": "a requirement for what tmd does not support",
    "odd-name": "a name that PDDL does not have, and planners accept",
    "glued-variable": "no blank before a variable",
    "type-twice": "a type that is declared twice",
    "undeclared-parent": "a parent of a type that is not declared itself",
    "variable-twice": "a variable that stands twice in the declaration of a predicate",
    "glued-dash": "no space between a dash and its type",
    "parent-after-child": "a type before its parent",
    "empty-condition": "() for an empty condition",
    "nested-when": 'a "when" within a "when"',
    "said-twice": "a fact or condition that stands twice",
    "contradictory-effects": "an action adds and deletes the same atom",
    "unused-predicate": "a predicate that no action speaks of",
    "unused-parameter": "a parameter that its action does not speak of",
    "no-effect": "an action that changes nothing",
    "never-applies": "an action that can never apply",
    "never-produced": "a predicate that actions need, and that nothing makes true",
    "too-many-cases": "a condition that is too large to be written out",
    "type-without-objects": "an action over a type that has no objects",
    "unreachable-goal": "a goal that no action reaches",
    "goal-holds": "a goal that holds at the start",
    "ambiguous-domain": "several domains have the name that a problem gives",
    "unserved-verb": "a verb that no action and no demonstration serves",
    "unknown-target": "a noun that leads to nothing in the domain",
    "unread-noun": "a name of a class that is not read as a noun where it is said",
    "impossible-goal": "a goal of a verb, or an adjective, that nothing in any environment can fulfil",
    "idle-phrase": "a phrase row that does not fire on its own example",
    "domain-not-found": "the domain of a problem is not there to check it against",
}
_NOTES = {
    "synonym-with-goal": "a verb that has a goal of its own and stands for another verb",
    "no-goal": "a verb that has no goal",
    "too-many": "a file has more problems than are shown",
}
SEVERITY: Mapping[str, Severity] = {
    **dict.fromkeys(_ERRORS, Severity.ERROR),
    **dict.fromkeys(_WARNINGS, Severity.WARNING),
    **dict.fromkeys(_NOTES, Severity.NOTE),
}
SUMMARY: Mapping[str, str] = _ERRORS | _WARNINGS | _NOTES
