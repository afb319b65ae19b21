"""The lit sentence: every character of the text is there, and verbs, objects and skipped words are marked."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.view.conftest import TEXT, corpus
from tests.view.reading import Reader
from tmd.grounded import Grounded
from tmd.language import parse
from tmd.language.clause import Clause, Parsed, Span
from tmd.pddl.plan_file import parse_instruction
from tmd.view.clauses import NOTHING, OBJECT, VERB, lit_choice, lit_sentence, phrases
from tmd.view.meaning import meanings_in
from tmd.world.world import World

WORDS = [
    "take",
    "put",
    "the",
    "cup",
    "fridge",
    "water",
    "it",
    "turn",
    "on",
    "off",
    "two",
    "cups",
    "and",
    "then,",
    "<b>",
    "&",
    '"',
    "banana's",
    "heat;",
    "microwave",
]


def shown(fragment: str) -> str:
    """The text that a fragment shows, without the labels under it and the numbers of clauses."""
    number = re.compile(r'<span class="tmd-number">[0-9]+</span>')
    return Reader(number.sub("", fragment).replace("\r", "&#13;")).without("small")


def test_verbs_and_objects_are_lit_with_what_they_mean(kitchen: World, grounded: Grounded) -> None:
    fragment = lit_choice(grounded.parsed, grounded.plans[0], kitchen)
    reader = Reader(fragment)
    assert [a["title"] for a in reader.of_class("tmd-verb")] == ["verb: fill", "verb: heat"]
    titles = [a["title"] for a in reader.of_class("tmd-object")]
    assert titles == ["object: cup", "object: water", "object: it, which is cup", "object: microwave"]
    labels = [text for inside, text in reader.texts if "small" in inside]
    assert labels == ["cup1", "water", "cup1", "microwave1"]


def test_what_names_nothing_and_what_nothing_accounts_for_is_marked(kitchen: World) -> None:
    parsed = parse("Zzyzx blorf wug. Take the banana.")
    reader = Reader(lit_sentence(parsed, meanings_in(parsed.clauses, [], kitchen)))
    assert NOTHING in reader.text and len(reader.of_class("tmd-none")) == 1 and reader.of_class("tmd-skipped")


def test_skipped_words_tell_why() -> None:
    parsed = parse("Zzyzx blorf wug. Take the cup.")
    assert parsed.skipped
    titles = [a["title"] for a in Reader(lit_sentence(parsed)).of_class("tmd-skipped")]
    assert titles and all(title.startswith("no clause: ") for title in titles)


def test_html_in_a_text_is_only_text() -> None:
    text = 'Take the <script>alert("cup")</script> & the "mug".'
    reader = Reader(lit_sentence(parse(text)))
    assert "script" not in reader.tags()
    assert shown(lit_sentence(parse(text))) == text


@settings(max_examples=50)
@given(st.lists(st.one_of(st.sampled_from(WORDS), st.text(max_size=6)), max_size=25).map(" ".join))
def test_nothing_of_any_text_is_lost(text: str) -> None:
    parsed = parse(text)
    fragment = lit_sentence(parsed, [dict.fromkeys(clause.objects, ("x1",)) for clause in parsed.clauses])
    assert shown(fragment) == text


@settings(max_examples=50)
@given(st.lists(st.tuples(st.integers(0, 20), st.integers(0, 20)), max_size=6))
def test_clauses_that_overlap_lose_nothing_either(ends: list[tuple[int, int]]) -> None:
    text = "take the cup of tea x"
    clauses = tuple(Clause("take", ("cup",), span=Span(*sorted(pair))) for pair in ends)
    assert shown(lit_sentence(Parsed(text, clauses))) == text


@pytest.mark.parametrize("domain", ["kitchen", "living_room"])
def test_the_words_of_nearly_every_clause_are_found(domain: str) -> None:
    found = wanted = verbs = clauses = 0
    for demonstration in corpus(domain).demonstrations()[::3]:
        parsed = parse(demonstration.text, corpus(domain).lexicon)
        for clause in parsed.clauses:
            kinds = phrases(parsed.text, clause)
            clauses += not clause.implied
            verbs += any(p.kind == VERB for p in kinds)
            wanted += len(clause.objects)
            found += len({p.name for p in kinds if p.kind == OBJECT})
    # "the trash goes into the can" was read as "put", "the blind should be down" as "lower": such verbs are not written
    assert verbs >= 0.92 * clauses and found >= 0.97 * wanted


def test_a_particle_that_stands_apart_is_lit_as_well() -> None:
    text = "Turn the tv on."
    (clause,) = parse(text).clauses
    assert [(text[slice(*p.span)], p.kind) for p in phrases(text, clause)] == [
        ("Turn", VERB), ("tv", OBJECT), ("on", VERB),
    ]  # fmt: skip


def test_the_style_touches_nothing_else() -> None:
    from tmd.view.markup import style

    rules = [line for line in style().splitlines() if "{" in line and not line.startswith(("@", " "))]
    assert rules and all(line.startswith((".tmd", "[data-theme")) for line in rules)


def test_the_text_of_the_example_is_there(kitchen: World, grounded: Grounded) -> None:
    assert shown(lit_choice(grounded.parsed, grounded.plans[0], kitchen)) == TEXT


def test_what_the_plan_has_nothing_to_do_with_stands_in_brackets(kitchen: World) -> None:
    """WordNet finds milk for *mixture*: a plan without milk does not mean it. A part stands for its whole."""
    parsed = parse("Fill the cup with water. Stir the mixture. Open the fridge.")
    plan = ["find(cup1)", "moveto(cup1)", "grasp(cup1)", "moveto(fridge1)", "keep(cup1, fridge1_dispenser, in)"]
    served = [[parse_instruction(text) for text in (*plan, "press(fridge1_button)")], []]
    served.append([parse_instruction("open(fridge1_door)")])
    fill, stir, open_it = meanings_in(parsed.clauses, enumerate(served), kitchen)
    assert fill == {"cup": ("cup1",), "water": ("water",)}
    assert stir == {"mixture": ("(milk1)",)} and open_it == {"fridge": ("fridge1",)}


def test_all_of_several_things_are_named(kitchen: World) -> None:
    taken = [parse_instruction(f"grasp({bowl})") for bowl in ("bowl1", "bowl2")]
    for text, names in (("Take both bowls.", ("bowl1", "bowl2")), ("Take the bowl.", ("bowl1",))):
        (meant,) = meanings_in(parse(text).clauses, [(0, taken)], kitchen)
        assert meant["bowl"] == names
