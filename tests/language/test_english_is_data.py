"""No word of English stands in the program: lists of words and comparisons with one belong into data files."""

import ast
import re
from functools import cache
from pathlib import Path

import tmd
from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import data_text, sections
from tmd.language.syntax.tagger import FEATURES

ROOT = Path(tmd.__file__).parent
FILES = sorted(
    path
    for place in ("language", "goals", "readers/rules.py")
    for path in ([ROOT / place] if place.endswith(".py") else (ROOT / place).rglob("*.py"))
    if path.is_file() and "data" not in path.relative_to(ROOT).parts
)
GRAMMAR = ROOT / "language" / "data" / "clauses.lark"
ALLOWED = {
    **dict.fromkeys(("evidence", "probability"), "keys of the JSON of learned goals"),
    **dict.fromkeys(Clause.__dataclass_fields__, "fields of a clause, also in JSON"),
    **dict.fromkeys(("base", "ed", "ing", "inf", "possessive"), "forms of words"),
    **dict.fromkeys(("and", "or", "not", "imply", "forall", "exists", "when", "either", "total"), "signs of PDDL"),
    **dict.fromkeys(("object", "number", "define", "domain", "problem"), "names of PDDL"),
    **dict.fromkeys(("condition", "purpose", "duration", "setting"), "roles of a span in the notation of clauses"),
    **dict.fromkeys(("st", "nd", "rd", "th"), "endings of figures"),
    **dict.fromkeys(("markup", "num", "stop", "comma"), "groups of a pattern"),
    **dict.fromkeys(("id", "reason", "example", "paraphrase", "note", "means", "read", "as"), "keys of data files"),
    **dict.fromkeys(("table", "class", "pattern", "phrases", "unless", "form", "terms", "parts"), "keys of data files"),
    **dict.fromkeys(
        (
            "include",
            "predicates",
            "types",
            "verbs",
            "phrasal",
            "nouns",
            "verb_synonyms",
            "goals",
            "attributes",
            "groups",
            "phrases",
        ),
        "keys of lexicons",
    ),
}
ALLOWED |= dict.fromkeys(re.findall(r"^[?]?([a-z_]+):", GRAMMAR.read_text("utf-8"), re.M), "rules of the grammar")
"""Words that may stand there, each with the reason; so may the names of sections of ``words.txt``."""
ALLOWED_IN = {
    "rows.py": frozenset({"word", "left", "right", "beyond", "last", "next", "stem", "form"}),
    "tagger.py": FEATURES,
}
"""What tokens and features are called in conditions."""
ENGLISH = frozenset(
    {part for words in sections().values() for word in words for part in (word, *word.strip("!").split("_"))}
    | set(data_text("wordnet_words.txt.gz").split())
)


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


_WORD = re.compile(r"[a-z][a-z_]*[a-z](?:'[a-z]+)?")
_ALTERNATIVES = re.compile(r"(?<![\w{@<])[a-z']{2,}(?:\|[a-z']{2,})+")


def _words(node: ast.AST) -> list[str]:
    """The English words that are parts of a literal."""
    if isinstance(node, ast.Constant):
        text = node.value if isinstance(node.value, str) else ""
        return [text] if _WORD.fullmatch(text) and text in ENGLISH and text not in ALLOWED else []
    if isinstance(node, ast.Dict):
        return [word for part in (*node.keys, *node.values) if part for word in _words(part)]
    if isinstance(node, ast.Set | ast.Tuple | ast.List):
        return [word for part in node.elts for word in _words(part)]
    return []


def _offence(node: ast.AST) -> list[str]:
    """The English words for which a place in the program is refused."""
    if isinstance(node, ast.Compare):
        return [word for part in (node.left, *node.comparators) for word in _words(part)]
    if isinstance(node, ast.MatchValue):
        return _words(node.value)
    words: list[str] = []
    if isinstance(node, ast.Set | ast.Tuple | ast.List | ast.Dict):
        words = _words(node)
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "split":
        text = node.func.value
        if isinstance(text, ast.Constant) and isinstance(text.value, str):
            words = [word for part in text.value.split() for word in _words(ast.Constant(part))]
    elif isinstance(node, ast.Constant) and isinstance(node.value, str) and "\n" not in node.value:
        runs = [run[0].split("|") for run in _ALTERNATIVES.finditer(node.value)]
        words = [part for run in runs for part in run if _words(ast.Constant(part))]
    return words if len(words) > 1 and not all(word in sections() for word in words) else []


def offences(tree: ast.AST, allowed: frozenset[str] = frozenset()) -> list[tuple[int, str]]:
    """Return line and words of lists with several English words, and of comparisons with one."""
    spared: set[int] = set()  # docstrings, names of attributes, endings of words
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) or (isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__slots__"):
            spared.add(id(node.value))
        elif isinstance(node, ast.Call) and getattr(node.func, "attr", "") in ("startswith", "endswith"):
            spared.update(id(part) for part in node.args)
    found = {
        (getattr(node, "lineno", 0), " ".join(words))
        for node in ast.walk(tree)
        if id(node) not in spared and (words := [word for word in _offence(node) if word not in allowed])
    }
    return sorted(found)


def test_no_english_word_stands_in_the_program() -> None:
    lines = [
        f"{path.relative_to(ROOT.parent)}:{line}: {words}"
        for path in FILES
        for line, words in offences(tree_of(path), frozenset(ALLOWED_IN.get(path.name, ())))
    ]
    assert not lines, "\n".join([f"{len(lines)} places", *lines])


def test_words_in_the_program_are_found() -> None:
    text = (
        'A = {"cup", "plate"}\nif w == "cup" or w == "base": pass\nB = section("nouns"), section("verbs")\n'
        'C = ("cup",)\nD = "cup plate".split()\nE = re.compile(r"the|an")\nF = ["nouns", "adverbs"]\n'
    )
    assert [line for line, _ in offences(ast.parse(text))] == [1, 2, 5, 6]


def sections_asked_for(tree: ast.AST) -> set[str]:
    """Return the names of sections that a module looks words up in."""
    calls = (node for node in ast.walk(tree) if isinstance(node, ast.Call))
    asking = (
        c for c in calls if getattr(c.func, "attr", getattr(c.func, "id", "")) in ("among", "stem_among", "section")
    )
    constants = (arg for call in asking for arg in call.args if isinstance(arg, ast.Constant))
    return {arg.value for arg in constants if isinstance(arg.value, str)}


def test_sections_of_words_exist() -> None:
    for path in FILES:
        assert sections_asked_for(tree_of(path)) <= sections().keys(), path
