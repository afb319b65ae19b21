"""Text to clauses: the paper's example, the mechanisms of the parser, and what never happens."""

import string
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.language import Lexicon, Parsed, parse, print_clause, read_clause
from tmd.language.clause import Mood, Quantifier
from tmd.language.lexicon.lexicon import sections
from tmd.language.parser import FOREIGN, NO_VERB, NO_WORDS, is_filler
from tmd.language.syntax.brackets import REMINDER
from tmd.language.syntax.tokens import Kind, tokenise


def clauses(text: str, lexicon: Lexicon | None = None) -> list[str]:
    return [print_clause(c) for c in parse(text, lexicon).clauses]


def test_the_paper_s_example() -> None:
    text = "Take the cup with water and then ignite the stove. Now place the cup on the stove and wait."
    assert clauses(text) == [
        "(take, [cup, water], with: cup -> water)",
        "(ignite, [stove])",
        "(place, [cup, stove], on: cup -> stove)",
        "(wait, [])",
    ]
    assert parse(text).skipped == ()


def test_one_behind_a_thing_is_its_number_unless_an_article_stands_before() -> None:
    home = Lexicon(kinds=frozenset({"trap", "crate"}))
    assert clauses("Open crate one and trap two.", home) == ["(open, [crate_1, trap_two])"]
    for text, name in (
        ("Open the crate one.", "crate_one"),
        ("Take red one.", "red_one"),
        ("Open crate one.", "crate_1"),
    ):
        assert parse(text, home).clauses[0].direct == (name,)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("turn the stove on", ["(turn_on, [stove])"]),
        ("Turn on the stove", ["(turn_on, [stove])"]),
        ("turn on | the | stove", ["(turn_on, [stove])"]),
        ("turn | on the stove", ["(turn_on, [stove])"]),
        ("switch the radio and the lamp off", ["(switch_off, [radio, lamp])"]),
        ("turn the knob on the stove", ["(turn, [knob, stove], on: knob -> stove)"]),
        ("fluff up the pillows", ["(fluff_up, [pillow])"]),
        ("screw in a new one", ["(screw_in, [one])"]),
        ("Deep-fry the fish.", ["(fry, [fish])"]),
        ("pick-up rope", ["(pick_up, [rope])"]),
        ("Put back rope.", ["(put_back, [rope])"]),
        ("turn it on wait till it clicks", ["(turn_on, [it])", "(wait, [])"]),
        (
            "Turn to the left go straight then turn to the right.",
            ["(turn, [left], to: -> left)", "(go, [])", "(turn, [right], to: -> right)"],
        ),
        ("help me fold the sheets", ["(fold, [sheet])"]),
        ("take, wash and dry the plate", ["(take, [plate])", "(wash, [plate])", "(dry, [plate])"]),
        ("Clean the pane, then polish glass.", ["(clean, [pane])", "(polish, [glass])"]),
    ],
)
def test_verbs_and_their_particles(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a cup of water", ["(have, [cup, water], of: cup -> water)"]),
        ("take some of the cups", ["(take, [cup])"]),
        ("Fill the raspberry syrups", ["(fill, [raspberry_syrup])"]),
        ("put it on the front left burner", ["(put, [it, front_left_burner], on: it -> front_left_burner)"]),
        ("sort the white ones", ["(sort, [white_one])"]),
        ("replace the light bulb", ["(replace, [light_bulb])"]),
        ("Set the third dial to low.", ["(set, [third_dial])"]),
        ("Hang the pastry slice on the hook.", ["(hang, [pastry_slice, hook], on: pastry_slice -> hook)"]),
        ("Mix the sand, baking powder and gravel.", ["(mix, [sand, baking_powder, gravel])"]),
        ("Put the two empty jars in the crate.", ["(put, [jar, crate], in: jar -> crate)"]),
        ("Take two or three ropes.", ["(take, [rope])"]),
        ("get the ice cream of your choice", ["(get, [ice_cream])"]),
        ("Fetch a rope and an opener.", ["(fetch, [rope, opener])"]),
        ("show Lena the photo", ["(show, [lena, photo], to: photo -> lena)"]),
    ],
)
def test_noun_phrases(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("put the bowl on the table in the hall", ["(put, [bowl, table, hall], on: bowl -> table, in: table -> hall)"]),
        ("bring me the crock-pot", ["(bring, [me, crock_pot], to: crock_pot -> me)"]),
        ("give her fresh water", ["(give, [her, water], to: water -> her)"]),
        ("put in the microwave", ["(put, [microwave], in: -> microwave)"]),
        (
            "take the pan off the stove with the gloves",
            ["(take, [pan, stove, glove], off: pan -> stove, with: pan -> glove)"],
        ),
        (
            "Put the rope where the pen was and the radio on the desk.",
            ["(put, [rope, pen], where: rope -> pen)", "(put, [radio, desk], on: radio -> desk)"],
        ),
        (
            "put the forks in the drawer, the plates in the sink and the cup on the rack",
            ["(put, [fork, drawer, plate, sink, cup, rack], in: fork -> drawer, in: plate -> sink, on: cup -> rack)"],
        ),
        (
            "Put crates, ropes and rakes on it.",
            ["(put, [crate, rope, rake, it], on: crate -> it, on: rope -> it, on: rake -> it)"],
        ),
        (
            "Pour paint in one jar and water in the other.",
            ["(pour, [paint, jar, water, one], in: paint -> jar, in: water -> one)"],
        ),
        (
            "Put one rope in the chest and then another in the crate.",
            ["(put, [rope, chest, one, crate], in: rope -> chest, in: one -> crate)"],
        ),
        ("Swap the pen and the rope.", ["(swap, [pen, rope], with: pen -> rope)"]),
        (
            "A tea with milk and sugar in the mug.",
            ["(have, [tea, milk, sugar, mug], with: tea -> milk, with: tea -> sugar, in: tea -> mug)"],
        ),
    ],
)
def test_attachment(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("take the bowl that is on the shelf", ["(take, [bowl, shelf], on: bowl -> shelf)"]),
        ("take the pot thats in the sink", ["(take, [pot, sink], in: pot -> sink)"]),
        ("take the chair that stands there to the hall", ["(take, [chair, hall], to: chair -> hall)"]),
        (
            "Put the letter lying on the chair on the desk.",
            ["(put, [letter, chair, desk], on: letter -> chair, on: letter -> desk)"],
        ),
        (
            "Everything that is lying around on the desk goes in the chest.",
            ["(put, [everything, desk, chest], on: everything -> desk, in: everything -> chest)"],
        ),
        ("The cup that is on the desk should be washed.", ["(wash, [cup, desk], on: cup -> desk)"]),
    ],
)
def test_relative_clauses(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("let the water boil", ["(boil, [water])"]),
        ("make sure the tv is off", ["(turn_off, [tv])"]),
        ("make sure the door is shut and the lamp is off", ["(close, [door])", "(turn_off, [lamp])"]),
        ("the plates should be washed and dried", ["(wash, [plate])", "(dry, [plate])"]),
        ("The blinds should be down.", ["(lower, [blind])"]),
        ("The gate should be open and the window shut.", ["(open, [gate])", "(close, [window])"]),
        ("The floor needs sweeping.", ["(sweep, [floor])"]),
        ("Both the cup and the mug go on the desk.", ["(put, [cup, mug, desk], on: cup -> desk, on: mug -> desk)"]),
        (
            "The rake should be in the shed and so should the hose.",
            ["(put, [rake, shed], in: rake -> shed)", "(put, [shed, hose], in: hose -> shed)"],
        ),
        ("The tools have to come off the bench.", ["(take, [tool, bench], off: tool -> bench)"]),
        ("A cup of tea would be lovely.", ["(have, [cup, tea], of: cup -> tea)"]),
        ("In the mug I'd like milk.", ["(have, [mug, milk], in: milk -> mug)"]),
        (
            "Shut the gate, but I'd like the rope on the desk.",
            ["(shut, [gate])", "(have, [rope, desk], on: rope -> desk)"],
        ),
        ("I'm freezing, a hot bath would be lovely.", ["(have, [bath])"]),
        ("A hot bath would be lovely, and close the gate.", ["(have, [bath])", "(close, [gate])"]),
        ("Mind you shut the gate.", ["(shut, [gate])"]),
        ("radio on, lamps off", ["(turn_on, [radio])", "(turn_off, [lamp])"]),
        ("oil in the jug, then shake it", ["(have, [oil, jug], in: oil -> jug)", "(shake, [it])"]),
        (
            "Put the pen in the chest, and the chest closed after that.",
            ["(put, [pen, chest], in: pen -> chest)", "(close, [chest])"],
        ),
        ("It would be lovely if there were some soup in the pot.", ["(be, [soup, pot], in: soup -> pot)"]),
        ("I don't suppose you could water the fern?", ["(water, [fern])"]),
        ("I was hoping we might have some tea.", ["(have, [tea])"]),
        ("Would it be all right if the lamp were on?", ["(turn_on, [lamp])"]),
        ("The gate, however, is to be shut.", ["(close, [gate])"]),
        ("The bag should be tied up.", ["(tie_up, [bag])"]),
        ("Please make close the gate.", ["(close, [gate])"]),
    ],
)
def test_demands_and_wishes(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "Take everything off the garden bench but the rake.",
            ["(take, [everything, garden_bench, rake], except: everything -> rake, off: everything -> garden_bench)"],
        ),
        (
            "Put every rope except the one on the desk on the shelf.",
            ["(put, [rope, one, desk, shelf], except: rope -> one, on: one -> desk, on: rope -> shelf)"],
        ),
        (
            "Apart from the red cup, all the cups should be on the desk.",
            ["(put, [red_cup, cup, desk], except: cup -> red_cup, on: cup -> desk)"],
        ),
        (
            "Everything else goes in the crate.",
            ["(put, [thing, crate], in: thing -> crate)"],
        ),
        (
            "Serve tea with neither milk nor sugar.",
            ["(serve, [tea, milk, sugar], without: tea -> milk, without: tea -> sugar)"],
        ),
    ],
)
def test_exceptions(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("How would you fetch me a rope?", ["(fetch, [me, rope], to: rope -> me)"]),
        ("Can you find the rake and hang it on the hook?", ["(find, [rake])", "(hang, [it, hook], on: it -> hook)"]),
        ("Rope is the best thing, can I have some rope?", ["(have, [rope])"]),
    ],
)
def test_questions_that_ask_for_something(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Put the pen in the chest, no wait, in the crate.", ["(put, [pen, crate], in: pen -> crate)"]),
        ("Put the cup in the crate, no, I mean the mug.", ["(put, [crate, mug], in: mug -> crate)"]),
        ("Put the cup in the crate, no, the box.", ["(put, [cup, box], in: cup -> box)"]),
        ("Serve Ann the tea, no, sorry, the soup.", ["(serve, [ann, soup], to: soup -> ann)"]),
        ("Put the pen, I mean the rope, in the chest.", ["(put, [rope, chest], in: rope -> chest)"]),
        ("Both chests, open them.", ["(open, [chest])"]),
        ("The chest's open, shut it.", ["(shut, [it])"]),
        ("I'm finished with the rake, hang it on the hook.", ["(hang, [it, hook], on: it -> hook)"]),
    ],
)
def test_corrections_and_topics(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("After filling the cup, wait", ["(fill, [cup])", "(wait, [])"]),
        ("use the remote to switch on the radio", ["(use, [remote])", "(switch_on, [radio])"]),
        ("boil the water until it bubbles, then wait", ["(boil, [water])", "(wait, [])"]),
    ],
)
def test_what_is_done_first_comes_first(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("TAKE THE CUP", ["(take, [cup])"]),
        ("took the cup", ["(take, [cup])"]),
        ("warm the milk an pour it out", ["(warm, [milk])", "(pour_out, [it])"]),
        ("take the microwav", ["(take, [microwave])"]),
        ("open the offcie door", ["(open, [office_door])"]),
        ("heat it for 10minutes", ["(heat, [it])"]),
        ("1) take the cup 2) fill it", ["(take, [cup])", "(fill, [it])"]),
        ("Take the cup and take the cup and wait", ["(take, [cup])", "(wait, [])"]),
        ("Take the cup. Take the cup.", ["(take, [cup])", "(take, [cup])"]),
        ("trow the sheers in the bin n close it frist", ["(throw, [sheer, bin], in: sheer -> bin)", "(close, [it])"]),
        ("Alright, let 's oil the hinge.", ["(oil, [hinge])"]),
        ("Fe\u200btch the ro\xadpe.", ["(fetch, [rope])"]),
        ("Oil the <b>hinge</b> &amp; the lock 🙂.", ["(oil, [hinge, lock])"]),
        ("feed the cat at 6 and at 7 pm wait", ["(feed, [cat])", "(wait, [])"]),
        ("Sweep aisle A, then stop.", ["(sweep, [aisle_a])", "(stop, [])"]),
        ("rope -> shed", ["(bring, [rope, shed], to: rope -> shed)"]),
        ("rake: shed -> bench", ["(bring, [rake, shed, bench], from: rake -> shed, to: rake -> bench)"]),
        ("Fill the pot w/ water", ["(fill, [pot, water], with: pot -> water)"]),
        ("lamp: off; gate: shut", ["(turn_off, [lamp])", "(close, [gate])"]),
        ("rope = shed", ["(bring, [rope, shed], to: rope -> shed)"]),
        ("Into the shed: the rope, the rake.", ["(have, [shed, rope, rake], into: rope -> shed, into: rake -> shed)"]),
        (
            "Put the rope and the rake both in the shed.",
            ["(put, [rope, rake, shed], in: rope -> shed, in: rake -> shed)"],
        ),
        ("Shut the gate pleeease", ["(shut, [gate])"]),
        ("The gate! Shut it!", ["(shut, [gate])"]),
        ("the hinge - oil it", ["(oil, [hinge])"]),
        ("the gate!! the shed door!! close pls", ["(close, [gate, shed_door])"]),
        ("the jug: the cork in, shake it", ["(have, [jug, cork], in: cork -> jug)", "(shake, [jug])"]),
        ("The lamp! Off!", ["(turn_off, [lamp])"]),
        ("Make it dry, the rope!", ["(make, [rope])"]),
        (
            "Clear the bench (rope -> shed)",
            ["(clear, [bench])", "(bring, [rope, shed], to: rope -> shed)"],
        ),
        ("Shut the gate till six.", ["(shut, [gate])"]),
        ("Take everything what is wet to the shed.", ["(take, [everything, shed], to: everything -> shed)"]),
        ("Oil the hinge, after shut the gate.", ["(oil, [hinge])", "(shut, [gate])"]),
    ],
)
def test_written_in_a_hurry(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("I can't see a thing in here, turn the lamp up.", ["(turn_up, [lamp])"]),
        ("Fetch the rope. I'm going to need it.", ["(fetch, [rope])"]),
        ("I'm tired and you should oil the hinge.", ["(oil, [hinge])"]),
        ("If the jug is full, don't bother. Close the gate.", ["(close, [gate])"]),
        ("Close the gate and don't bother with the shed.", ["(close, [gate])"]),
        ("Close the gate, I'll lock the shed myself.", ["(close, [gate])"]),
        ("So, take the cup", ["(take, [cup])"]),
        ("I hate the dark, the lamp is off, so light it.", ["(light, [it])"]),
        ("I like to read at night, it is dark, so light the lamp.", ["(light, [lamp])"]),
        ("There is such a draught that I'll catch a cold, so shut the gate.", ["(shut, [gate])"]),
        ("Somebody left the gate open! Shut it.", ["(shut, [it])"]),
        ("You should oil the hinge, so fetch the oil.", ["(oil, [hinge])", "(fetch, [oil])"]),
        ("Shut the gate, dear, and oil the hinge.", ["(shut, [gate])", "(oil, [hinge])"]),
        ("I promise it was not me, but shut the gate.", ["(shut, [gate])"]),
        ("Shut the gate, my dear.", ["(shut, [gate])"]),
        ("Shut the gate, the goats are loose!", ["(shut, [gate])"]),
        ("Lamp off, the baby is asleep, it is late.", ["(turn_off, [lamp])"]),
        ("He never puts it away, so take the rake.", ["(take, [rake])"]),
        ("Uncle's coming up the path, shut the gate.", ["(shut, [gate])"]),
        ("You know how they are, so could you shut the gate?", ["(shut, [gate])"]),
        ("The hinge is dry, then oil it.", ["(oil, [it])"]),
        ("Oil the hinge and shut the gate, in that order.", ["(oil, [hinge])", "(shut, [gate])"]),
        ("Shut the gate by noon.", ["(shut, [gate])"]),
        ("Put the eggs in the shed, they are getting warm.", ["(put, [egg, shed], in: egg -> shed)"]),
        ("Shut the gate, the farmer's here.", ["(shut, [gate])"]),
        ("The gate on the left, can you shut it?", ["(have, [gate, left], on: gate -> left)", "(shut, [it])"]),
        ("I tripped over a can, nearly fell, so shut the gate.", ["(shut, [gate])"]),
        ("The hinge is dry; it is to be oiled.", ["(oil, [it])"]),
        (
            "The rope that stands on the bench belongs in the shed.",
            ["(put, [rope, bench, shed], on: rope -> bench, in: rope -> shed)"],
        ),
        ("Take the pot. Stick the egg in there.", ["(take, [pot])", "(stick, [egg, there], in: egg -> there)"]),
    ],
)
def test_what_is_said_beside_a_request_takes_nothing_away(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("Shut the gate, they wander off.", "wander"),
        ("I'd be ashamed to sell that rope. Oil the hinge.", "sell"),
        ("My feet get cold. Shut the gate.", "get"),
        ("Forgive the noise, but shut the gate.", "forgive"),
    ],
)
def test_what_somebody_else_does_is_marked(text: str, told: str) -> None:
    assert [clause.verb for clause in parse(text).clauses if clause.told] == [told]


def test_requests_are_not_taken_for_what_somebody_does() -> None:
    for text in (
        "I want the rope. Shut the gate.",
        "Could someone shut the gate?",
        "I want the rope, and if it is wet, dry it",
    ):
        assert not any(clause.told for clause in parse(text).clauses)


@pytest.mark.parametrize(
    ("text", "forbidden"),
    [
        ("Do not touch the stove.", "(touch, [stove])"),
        ("The radio must not be moved, please.", "(move, [radio])"),
        ("Shut the gate. It must not be painted.", "(paint, [it])"),
        ("Stop watering the fern.", "(water, [fern])"),
        ("Under no circumstances open the shed.", "(open, [shed])"),
        ("Use neither the saw nor the drill.", "(use, [saw, drill])"),
        ("Take care that you don't break the pane.", "(break, [pane])"),
        ("Don't use the axe or the knife to cut the rope.", "(use, [axe, knife])"),
        ("Cut the rope. Don't use the axe to cut it.", "(use, [axe])"),
        ("Use the saw, not the axe, to cut the rope.", "(use, [axe])"),
        ("Use the saw instead of the axe to cut the rope.", "(use, [axe])"),
        ("Put the saw, not the axe, in the shed and close the door.", "(put, [axe, shed], in: axe -> shed)"),
        ("Don't pour any oil in the jug, just water.", "(pour, [oil, jug], in: oil -> jug)"),
        ("Never open the shed, only the gate, and take the saw.", "(open, [shed])"),
    ],
)
def test_what_must_not_be_done_is_a_constraint(text: str, forbidden: str) -> None:
    parsed = parse(text)
    assert [print_clause(c) for c in parsed.constraints] == [forbidden]
    assert all(c.mood is Mood.AVOID for c in parsed.constraints)
    assert forbidden not in [print_clause(c) for c in parsed.clauses]


@pytest.mark.parametrize(
    ("text", "done"),
    [
        ("Do not touch the stove.", []),
        ("Use the saw and not the axe to cut the rope.", ["(use, [saw])", "(cut, [rope])"]),
        ("Don't use the axe to cut the rope, use the saw.", ["(use, [saw])"]),
        ("Don't pour any oil in the jug, just water.", ["(pour, [jug, water], in: water -> jug)"]),
        ("Never open the shed, only the gate, and take the saw.", ["(open, [gate])", "(take, [saw])"]),
        ("Take the rope, but leave the crate there.", ["(take, [rope])", "(leave, [crate])"]),
        ("Leave the radio on.", ["(leave, [radio])"]),
        ("The blind should stay up.", ["(leave, [blind])"]),
    ],
)
def test_what_is_done_beside_what_is_forbidden_or_kept(text: str, done: list[str]) -> None:
    parsed = parse(text)
    assert [print_clause(c) for c in parsed.clauses] == done
    assert [c.mood for c in parsed.clauses] == [Mood.KEEP if c.verb == "leave" else Mood.DO for c in parsed.clauses]


@pytest.mark.parametrize(
    ("text", "nouns"),
    [
        ("The lamp should not be on.", ["lamp"]),
        ("Make sure the lamp isn't on.", ["lamp"]),
        ("No cups should be left on the desk.", ["cup"]),
        ("Shut the gate, but the window should not be shut.", ["window"]),
        ("None of the lamps should be on.", ["lamp"]),
        ("The gate must not stay open.", ["gate"]),
    ],
)
def test_a_negated_state_is_no_plain_instruction(text: str, nouns: list[str]) -> None:
    last = parse(text).clauses[-1]
    assert list(last.direct) == nouns
    assert {last.phrase(noun).quantifier for noun in nouns} == {Quantifier.NONE}


@pytest.mark.parametrize(
    ("text", "field", "value"),
    [
        ("boil the water until it bubbles, then wait", "condition", "until it bubbles"),
        ("If the tv is on, turn it off", "condition", "if the tv is on"),
        ("When the water boils pour it into the cup", "condition", "when the water boils"),
        ("heat the milk for 3 minutes", "duration", "for 3 minutes"),
        ("heat the milk for 10MIN", "duration", "for 10min"),
        ("Soak the rope for 3 to 5 hours.", "duration", "for 3 to 5 hours"),
        ("boil water to make tea", "purpose", "to make tea"),
        ("rinse the cup so that it is clean", "purpose", "so that it is clean"),
        ("Turn it to 180 degrees.", "setting", "to 180 degrees"),
    ],
)
def test_conditions_purposes_durations_and_settings_are_no_clauses(text: str, field: str, value: str) -> None:
    assert str(getattr(parse(text).clauses[0], field)).lower() == value


@pytest.mark.parametrize(
    ("text", "word", "said", "negated"),
    [
        ("If the lamp is on, shut the door.", "if", ["(be, [lamp])"], False),
        ("Shut the door unless the lamp is on.", "unless", ["(be, [lamp])"], False),
        ("If the lamp isn't on, shut the door.", "if", ["(be, [lamp])"], True),
        ("When the water boils, shut the door.", "when", ["(boil, [water])"], False),
        ("Shut the door once the pen is in the chest.", "once", ["(be, [pen, chest], in: pen -> chest)"], False),
    ],
)
def test_what_a_condition_says_is_read(text: str, word: str, said: list[str], negated: bool) -> None:
    (clause,) = parse(text).clauses
    assert print_clause(clause) == "(shut, [door])"
    (condition,) = clause.conditions
    assert (condition.word, [print_clause(c) for c in condition.clauses]) == (word, said)
    assert condition.negated == negated


def test_a_condition_is_carried_to_what_is_joined_to_its_clause() -> None:
    first, second, third = parse("If the lamp is on, turn it off and take it out, otherwise fetch it.").clauses
    assert [c.carried for clause in (first, second) for c in clause.conditions] == [False, True]
    assert third.otherwise
    assert parse("If it rains, close the door. If not, open it.").clauses[-1].otherwise


def test_a_purpose_without_an_object_is_that_of_what_is_acted_on() -> None:
    (purpose,) = parse("Put the kettle on the stove to boil.").clauses[0].conditions
    assert [print_clause(clause) for clause in purpose.clauses] == ["(boil, [it])"]


@pytest.mark.parametrize(
    ("text", "noun"),
    [
        ("Wash everything on the bench that is dirty.", "everything"),
        ("Wash all the brushes on the bench that are dirty.", "brush"),
        ("Wash the brush on the bench that is dirty.", "bench"),
        ("Put all the brushes on the bench that is dry.", "bench"),
        ("Put all the brushes on the bench that are dry in the shed.", "brush"),
    ],
)
def test_a_relative_clause_is_about_the_noun_that_agrees(text: str, noun: str) -> None:
    (clause,) = parse(text).clauses
    assert [name for name in clause.objects if clause.phrase(name).attributes] == [noun]


def test_a_relative_clause_of_what_is_named_first_is_not_lost() -> None:
    (clause,) = parse("The ropes that are wet, carry them to the shed.").clauses
    assert clause.phrase("rope").attributes == ("wet",)


@pytest.mark.parametrize("opener", ["Should the gate be open", "In the event that the gate is open"])
def test_openers_of_conditions(opener: str) -> None:
    (clause,) = parse(f"{opener}, shut it.").clauses
    (condition,) = clause.conditions
    assert [print_clause(inner) for inner in condition.clauses] == ["(be, [gate])"]
    assert condition.clauses[0].result == "open"


def test_what_is_not_done_yet_is_told_by_an_adjective() -> None:
    assert parse("Iron every coat that hasn't been ironed yet.").clauses[0].phrase("coat").attributes == ("not_ironed",)
    assert parse("Turn off the lamps that are on.").clauses[0].phrase("lamp").attributes == ("on",)


def test_the_one_that_a_thing_goes_to_is_like_the_one_that_it_comes_from() -> None:
    clause = parse("Move the red pen from the left shelf to the right one.").clauses[0]
    assert clause.antecedents["right_one"][0] == "shelf"


def test_one_is_one_of_what_was_told_apart() -> None:
    _, second = parse("Throw away the wrapper and the empty can, then wash the full one.").clauses
    assert second.antecedents["one"][0] == "can"
    (clause,) = parse("Put the nuts in one bowl and the figs in the other.").clauses
    assert clause.antecedents["one"] == ("bowl",)
    (clause,) = parse("Sweep one of the two floors.").clauses
    assert clause.phrase("floor").number != 2


def test_ones_are_told_apart() -> None:
    clause = parse("The white one goes on the desk and the red one on the shelf.").clauses[0]
    assert list(clause.direct) == ["white_one", "red_one"]
    assert [clause.phrase(noun).attributes for noun in clause.direct] == [("white",), ("red",)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Wash the dirty pot and the full pot.", "(wash, [pot, one])"),
        (
            "Put the pot on the bench and the other pot too.",
            "(put, [pot, bench, one], on: pot -> bench, on: one -> bench)",
        ),
        (
            "Lay the rope that is in the shed on the bench, then the other rope as well.",
            "(lay, [rope, shed, bench, one], in: rope -> shed, on: rope -> bench, on: one -> bench)",
        ),
        (
            "Put the pot on the bench and the other pot in the chest.",
            "(put, [pot, bench, one, chest], on: pot -> bench, in: one -> chest)",
        ),
    ],
)
def test_things_of_one_name_are_told_apart_by_what_describes_them(text: str, expected: str) -> None:
    (clause,) = parse(text).clauses
    assert print_clause(clause).startswith(expected)
    assert clause.antecedents["one"][0] == clause.direct[0]
    assert clause.direct[1] == "one"


def test_a_thing_to_be_remembered_is_no_object_of_the_clause_before() -> None:
    parsed = parse("Put the rope back in the chest, and don't forget the lid.")
    assert [clause.direct for clause in parsed.clauses] == [("rope",)]
    assert [piece.reason for piece in parsed.skipped] == [REMINDER]


@pytest.mark.parametrize(
    ("text", "index", "name", "meant"),
    [
        ("Take the cup. Put it on the table.", 1, "it", ("cup",)),
        ("Take the cup and the plate. Wash them.", 1, "them", ("cup", "plate")),
        ("Take the cup and the plate. Wash them. Dry them.", 2, "them", ("cup", "plate")),
        ("Put the cup on the table and fill it.", 1, "it", ("cup",)),
        ("Take the pot, fill with water.", 1, "", ("pot",)),
        ("Fill the pot with water. Put it on the stove.", 1, "it", ("pot",)),
        ("Boil the water. Place it on the counter.", 1, "it", ("water",)),
        ("Take the plates. Wait. Turn on the oven. Bake.", 3, "", ("oven",)),
        ("Open the fridge. Take the eggs and boil them.", 2, "them", ("egg",)),
    ],
)
def test_antecedents(text: str, index: int, name: str, meant: tuple[str, ...]) -> None:
    assert parse(text).clauses[index].meant(name) == meant


def test_antecedents_are_ranked_and_never_of_the_own_clause() -> None:
    clause = parse("Take the cup from the shelf. Add water to it.").clauses[1]
    assert clause.antecedents["it"] == ("cup", "shelf")
    assert clause.resolved() == ("water", "cup")


def test_a_pronoun_may_mean_what_a_statement_spoke_of() -> None:
    assert parse("Those nuts are stale, bin them.").clauses[0].antecedents == {"them": ("nut",)}


@pytest.mark.parametrize("said", ["when you're done", "once you are finished", "as soon as you're ready"])
def test_a_condition_on_the_one_who_is_asked_is_none(said: str) -> None:
    (clause,) = parse(f"Shut the gate {said}.").clauses
    assert clause.conditions == ()


def test_please_is_nobody() -> None:
    assert parse("Oil the hinge, please.").skipped == ()


def test_him_is_a_thing_where_nothing_is_done_for_somebody() -> None:
    assert parse("Wake the dog up and brush him.").clauses[-1].antecedents["it"][0] == "dog"


def test_a_pronoun_said_twice_in_a_sentence_is_one_thing() -> None:
    last = parse("Fill the jug and heat it. Break the stone into it once it boils.").clauses[-1]
    (condition,) = last.conditions
    assert last.meant("it")[0] == condition.clauses[0].meant("it")[0] == "jug"


def test_persons_are_objects_but_nothing_to_find() -> None:
    clause = parse("Bring me the cup.").clauses[0]
    assert clause.objects == ("me", "cup")
    assert clause.resolved() == ("cup",)


def test_a_class_of_the_domain_is_a_noun_where_it_could_be_a_verb() -> None:
    lexicon = replace(Lexicon(verbs=frozenset({"pump", "lay"})), kinds=frozenset({"pump"}))
    assert clauses("Lay the hand pump on the desk.", lexicon) == ["(lay, [hand_pump, desk], on: hand_pump -> desk)"]
    assert clauses("Pump the wheel.", lexicon) == ["(pump, [wheel])"]


def test_domain_words() -> None:
    lexicon = Lexicon(verbs=frozenset({"plonk"}), phrasal={"fire_up": "turn_on"})
    assert clauses("fire the stove up and plonk the cup on it", lexicon) == [
        "(fire_up, [stove])",
        "(plonk, [cup, it], on: cup -> it)",
    ]


def test_quantities_and_numbers() -> None:
    clause = parse("Put two spoons and 3 forks next to burner 2").clauses[0]
    assert clause.objects == ("spoon", "fork", "burner_2")
    assert clause.quantities == {"spoon": "two", "fork": "3"}


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", NO_WORDS),
        (" \n\t🙂 …", NO_WORDS),
        ("Nimm die Tasse und stell sie auf den Tisch", FOREIGN),
        ("Prends la tasse et mets-la dans le four", FOREIGN),
        ("возьми чашку и поставь", FOREIGN),
        ("cups", NO_VERB),
        ("The cup is on the table.", "a statement, not an instruction"),
        ("I'm cold.", "a statement, not an instruction"),
        ("Where is the rope?", "a question, not an instruction"),
        ("You don't have to oil the saw.", "says what need not be done"),
    ],
)
def test_no_clause_but_a_reason(text: str, reason: str) -> None:
    parsed = parse(text)
    assert parsed.clauses == ()
    assert [s.reason for s in parsed.skipped] == [reason]


def test_what_is_not_read_beside_a_clause_is_told() -> None:
    (piece,) = parse("Put it in the chest, no wait, in the crate.").skipped
    assert (piece.text, piece.reason) == ("in the chest, no wait", "taken back by what was said next")
    assert [piece.text for piece in parse("Brew a tea, sweetened, and put it on the desk.").skipped] == ["sweetened"]


def test_signs_that_are_no_words_are_told() -> None:
    parsed = parse("Oil the <b>saw</b> \U0001f642")
    assert [piece.text for piece in parsed.skipped] == ["<b>", "</b> \U0001f642"]
    assert {piece.reason for piece in parsed.skipped} == {"a sign, not a word"}


def test_spans_point_into_the_original_text() -> None:
    text = "Robot, please\u0007 turn the STOVE | on, and wait."
    first, second = parse(text).clauses
    assert text[first.span.start : first.span.end] == first.text == "turn the STOVE | on"
    assert text[second.span.start : second.span.end] == second.text == "wait"


_WORDS = [
    "take",
    "put",
    "turn",
    "place",
    "water",
    "cup",
    "plate",
    "the",
    "a",
    "on",
    "in",
    "off",
    "up",
    "of",
    "with",
    "and",
    "then",
    ",",
    ".",
    ";",
    "if",
    "until",
    "when",
    "you",
    "it",
    "them",
    "that",
    "is",
    "not",
    "to",
    "let",
    "make",
    "sure",
    "please",
    "robot",
    "two",
    "3",
    "minutes",
    "which",
    "heated",
    "boiling",
    "left",
    "(",
    ")",
    "don't",
    "can",
    "|",
    "hot",
    "zorp",
]
_SENTENCES = st.lists(st.sampled_from(_WORDS), max_size=40).map(" ".join)
_ANY = st.text(alphabet=string.printable + "äß|\u2013\u2019🙂\u0000\u200b中", max_size=120)


def lost(parsed: Parsed) -> list[str]:
    """Return the words that no clause, constraint or entry of ``skipped`` covers and that are no filler."""
    spans = [c.span for c in (*parsed.clauses, *parsed.constraints)] + [s.span for s in parsed.skipped]
    return [
        token.text
        for token in tokenise(parsed.text)
        if token.kind in (Kind.WORD, Kind.NUM)
        and not any(s.start <= token.span.start and token.span.end <= s.end for s in spans)
        and not is_filler(token.text)
    ]


@settings(max_examples=400, deadline=None)
@given(st.one_of(_SENTENCES, _ANY))
def test_nothing_is_lost_and_nothing_raises(text: str) -> None:
    parsed = parse(text)
    assert lost(parsed) == []
    assert parse(text) == parsed
    for clause in parsed.clauses:
        assert clause.text == text[clause.span.start : clause.span.end] != ""
        assert all(name == name.lower() and " " not in name for name in clause.objects)
        assert all(r.target in clause.objects for r in clause.relations)
        assert all(r.source is None or r.source in clause.objects for r in clause.relations)
        copy = read_clause(print_clause(clause))
        assert (copy.verb, copy.objects, copy.relations) == (clause.verb, clause.objects, clause.relations)
    for skipped in parsed.skipped:
        assert skipped.reason
        assert skipped.text == text[skipped.span.start : skipped.span.end].strip()


@settings(max_examples=100, deadline=None)
@given(_SENTENCES)
def test_segment_marks_change_nothing(text: str) -> None:
    marked = text.replace(" ", " | ")
    assert [print_clause(c) for c in parse(marked).clauses] == [print_clause(c) for c in parse(text).clauses]


def test_a_long_text_gives_every_clause() -> None:
    parsed = parse("Take the cup and put it on the table. " * 1300)
    assert len(parsed.clauses) == 2600


@pytest.mark.parametrize("mark", ["(", "[", "- ", "and ", "water "])
def test_of_a_sentence_without_end_the_beginning_is_read(mark: str) -> None:
    parsed = parse("Take the cup. Fill the kettle " + mark * 50_000)
    assert print_clause(parsed.clauses[0]) == "(take, [cup])"
    assert "the sentence has more than 1,000 words" in {skipped.reason for skipped in parsed.skipped}


_THING = st.sampled_from(["cup", "red box", "rope", "saw", "garden chair", "bottle", "old lamp", "book"])
_PLACE = st.sampled_from(["in the shed", "on the shelf", "under the bench", "into the crate", "next to the door"])
_DEED = st.sampled_from(["wash", "take", "put away", "clean", "bring", "close", "move", "switch off"])


def _printed(text: str) -> list[str]:
    return [print_clause(clause) for clause in parse(text).clauses]


@given(_DEED, _THING, _THING)
def test_politeness_and_case_change_nothing(deed: str, thing: str, other: str) -> None:
    plain = _printed(f"{deed} the {thing} and the {other}")
    assert plain
    for text in (f"Please {deed} the {thing} and the {other}.", f"{deed} the {thing} and the {other} please",
                 f"Could you {deed} the {thing} and the {other}?", f"{deed} THE {thing} AND the {other}".upper(),
                 f"okay, now {deed} the {thing} and the {other}!"):  # fmt: skip
        assert _printed(text) == plain, text


@given(_THING, _THING, _PLACE)
def test_swapped_conjuncts_swap_the_objects(thing: str, other: str, place: str) -> None:
    first, second = (
        parse(f"Put the {thing} and the {other} {place}."),
        parse(f"Put the {other} and the {thing} {place}."),
    )
    assert set(first.clauses[0].objects) == set(second.clauses[0].objects)
    assert set(first.clauses[0].relations) == set(second.clauses[0].relations)


@given(_DEED, _THING, st.sampled_from(["Do not", "Don't", "Never", "Please do not", "You must not", "You mustn't"]))
def test_a_negation_turns_an_instruction_into_a_constraint(deed: str, thing: str, negation: str) -> None:
    said, denied = parse(f"{deed} the {thing}."), parse(f"{negation} {deed} the {thing}.")
    assert not denied.clauses
    assert [print_clause(c) for c in denied.constraints] == [print_clause(c) for c in said.clauses]


@given(_DEED, _THING, st.sampled_from(["except", "but", "apart from", "except for"]))
def test_an_exception_adds_what_is_excepted_and_nothing_else(deed: str, thing: str, word: str) -> None:
    name = parse(f"{deed} the {thing}").clauses[0].objects[0]
    (clause,) = parse(f"{deed} everything {word} the {thing}.").clauses
    assert clause.objects == ("everything", name)
    assert [tuple(relation)[1:] for relation in clause.relations] == [("everything", name)]


@given(_DEED, _THING, _THING)
def test_a_condition_stays_with_its_instruction(deed: str, thing: str, other: str) -> None:
    (clause,) = parse(f"If the {other} is dirty, {deed} the {thing}.").clauses
    assert clause.condition and print_clause(clause) == _printed(f"{deed} the {thing}")[0]


def test_each_word_of_the_lists_may_be_the_whole_text() -> None:
    for entry in sorted({entry for entries in sections().values() for entry in entries}):
        text = entry.strip("!").replace("_", " ")
        for whole in (text, f"{text.upper()}."):
            assert parse(whole).text == whole
