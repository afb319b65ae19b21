"""The steps of a request: its clauses, and what their conditions ask for, in the order of doing."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from tmd.goals.reasons import DOER
from tmd.goals.text_constraints import is_of_the_end
from tmd.goals.words import (
    BE,
    IT,
    NEGATED,
    is_condition,
    is_noun,
    is_one,
    is_pronoun,
    is_relation,
    is_verb,
    ranked,
    the_word,
    words_of,
)
from tmd.language.clause import AGENT, PERSONS, TO, Clause, Condition, Mood, Parsed, Quantifier, Relation, Skipped
from tmd.language.lexicon.lexicon import builtin, section, singular
from tmd.language.lexicon.names import split_name
from tmd.readers.interface import Step

USE: str = the_word("verbs", "using")
_ENDS = frozenset(".!?;")
# A first clause that so many others follow may be a heading: *tidy the floor. The toy goes on the shelf, …*
_FEWEST = 2


@dataclass(frozen=True, slots=True)
class RuleStep(Step):
    """A step as the rules read it.

    Attributes:
        clause: The clause with its grammar.
        guards: The conditions that guard the step.
        otherwise: Whether it is done where the guards of the step before it did not hold.
        optional: Whether it may be left out where it is not understood: *when they are done*.
        awaited: Whether it is waited for, not asked for: *until it boils*.
        loose: Whether it may be left out for any reason: a heading, or a purpose.
        explained: Whether the steps behind it say all that it asks for: *clear the desk: the pen in the box*.
        explains: What such a step is about; its own things are likely there: the pen on the desk.
    """

    clause: Clause
    guards: tuple[Condition, ...] = ()
    otherwise: bool = False
    optional: bool = False
    awaited: bool = False
    loose: bool = False
    explained: bool = False
    explains: str = ""


def about_things(clause: Clause, known: Callable[[str], bool]) -> Clause:
    """Return a clause with words that mean things here: "take her to the ward" of the cat, "put that thing there".

    Args:
        clause: The clause.
        known: Whether a noun means something here.
    """
    inner = tuple(replace(c, clauses=tuple(about_things(said, known) for said in c.clauses)) for c in clause.conditions)
    clause = _with_vague_nouns(_with_numbers(replace(clause, conditions=inner), known))
    acted_on = clause.direct or tuple(r.target for r in clause.relations if r.source is None)  # "operate on him"
    # "put a rug on her", "give her a bath"
    treated = clause.direct and not (is_pronoun(clause.direct[0]) or known(clause.direct[0]))
    places = tuple(
        r.target for r in clause.relations if is_relation(r.relation, "resting") or (treated and r.relation == TO)
    )
    for noun in (*acted_on, *places):
        if noun in PERSONS and any(map(known, clause.antecedents.get(noun, ())[:1])):
            clause = clause.renamed(noun, IT)
        elif is_noun(noun, "everybody") and not known(noun):
            people = the_word("nouns", "people")
            clause = clause.renamed(noun, people if known(people) else the_word("nouns", "whole"))
    return clause


def _with_vague_nouns(clause: Clause) -> Clause:
    """Return a clause with "that thing" as a pronoun, and "the dirty ones", of nothing before, as things."""
    for noun in clause.objects:
        phrase = clause.phrase(noun)
        one = not phrase.plural and phrase.quantifier is Quantifier.PLAIN and not phrase.attributes
        if is_one(noun) and phrase.attributes and not clause.antecedents.get(noun):
            clause = clause.renamed(noun, ranked("nouns", "vague")[0])
        if is_noun(noun, "vague") and one and not any(r.source == noun for r in clause.stated):
            clause = clause.renamed(noun, IT)  # but "the thing that is in the sink" is what is there
    return clause


def _with_numbers(clause: Clause, known: Callable[[str], bool]) -> Clause:
    """Return a clause with numbers as things of the kind that it speaks of: "all rooms but number 3"."""
    for noun in clause.objects:
        *called, number = split_name(noun)
        plain = all(is_noun(word, "numbered") for word in called)
        alone = plain and number.isdecimal() and noun not in clause.direct and not known(noun)
        kinds = [split_name(other)[-1] for other in clause.direct] if alone else []
        named = next((name for kind in kinds if known(name := f"{singular(kind)}_{number}")), noun)
        clause = clause.renamed(noun, named)
    return clause


def one_after_another(parsed: Parsed) -> Parsed:
    """Return a request with each thing in a clause of its own that goes where an earlier one of its clause is by then.

    *Put the mug on the table and the spoon next to it.*
    """
    return replace(parsed, clauses=tuple(part for clause in parsed.clauses for part in _in_turn(clause)))


def _in_turn(clause: Clause) -> Iterator[Clause]:
    for at, name in enumerate(clause.direct):
        targets = {noun for r in clause.relations if r.source == name for noun in clause.meant(r.target)[:1]}
        if clause.mood is Mood.DO and not targets.isdisjoint(clause.direct[:at]):
            yield _about(clause, clause.direct[:at])
            yield from _in_turn(_about(clause, clause.direct[at:]))
            return
    yield clause


def _about(clause: Clause, direct: tuple[str, ...]) -> Clause:
    """Return a clause as far as it acts on some of its things."""
    others = set(clause.direct).difference(direct)
    relations = tuple(r for r in clause.relations if r.source not in others)
    elsewhere = others.union(r.target for r in clause.relations).difference(direct, (r.target for r in relations))
    objects = tuple(name for name in clause.objects if name not in elsewhere)
    meant = {name: names for name, names in clause.antecedents.items() if name not in elsewhere}
    return replace(clause, direct=direct, relations=relations, objects=objects, antecedents=meant)


def with_unwanted_states(parsed: Parsed) -> Parsed:
    """Return a request with unwanted states as what shall be so: "don't leave the gate open", "no open gate".

    What shall not be so in the end may be so now.
    """
    unwanted = {clause: other for clause in parsed.constraints if (other := _as_state(clause)) is not None}
    clauses = in_text_order(parsed.clauses, unwanted.values())
    return replace(parsed, clauses=clauses, constraints=tuple(c for c in parsed.constraints if c not in unwanted))


def without_doers(parsed: Parsed, is_actor: Callable[[str], bool]) -> Parsed:
    """Return a request without those who shall do it: "let Joe wash the van", "have Joe wash it", "ask Joe to wash it".

    A plan chooses who acts. Those who were named are among what was skipped.

    Args:
        parsed: The request.
        is_actor: Whether a noun names those who act.
    """
    clauses: list[Clause] = []
    skipped = list(parsed.skipped)
    for place, clause in enumerate(parsed.clauses):
        doer, *others = clause.direct or ("",)
        if not doer or clause.mood is not Mood.DO or not is_actor(doer):
            clauses.append(clause)
            continue
        wanted = [inner for word, inner in _said(clause, "later") if is_condition(word, "purpose")]
        follows = place + 1 < len(parsed.clauses) and _same_sentence(parsed, clause, parsed.clauses[place + 1])
        verb = clause.verb in section("delegating")
        if others and _stands_before(doer, clause):
            clauses.append(replace(clause, direct=tuple(others), objects=tuple(n for n in clause.objects if n != doer)))
        elif verb and not clause.relations and (wanted or follows):
            clauses += wanted
        else:
            clauses.append(clause)
            continue
        skipped.append(Skipped(doer, clause.span, DOER))
    return replace(parsed, clauses=tuple(clauses), skipped=tuple(skipped))


def with_addressees(parsed: Parsed, is_actor: Callable[[str], bool]) -> Parsed:
    """Return a request with those who are addressed as those who act: "Anna, go to the hall".

    Args:
        parsed: The request.
        is_actor: Whether a noun names those who act.
    """
    for piece in parsed.skipped:
        noun = "_".join(re.findall(r"\w+", piece.text.lower()))
        if not (parsed.text[piece.span.end :].lstrip().startswith(",") and is_actor(noun)):
            continue
        clauses = [
            replace(clause, objects=(*clause.objects, noun), relations=(*clause.relations, by))
            if piece.span < clause.span and _ENDS.isdisjoint(parsed.text[piece.span.end : clause.span.start])
            else clause
            for clause in parsed.clauses
            for by in (Relation(AGENT, clause.direct[0] if clause.direct else None, noun),)
        ]
        told = clauses != list(parsed.clauses)
        rest = tuple(other for other in parsed.skipped if other is not piece or not told)
        parsed = replace(parsed, clauses=tuple(clauses), skipped=rest)
    return parsed


def _stands_before(noun: str, clause: Clause) -> bool:
    """Return whether a noun stands before the verb of its clause."""
    said = clause.text.lower().split()
    verbs = [at for at, word in enumerate(said) if (known := builtin().verb(word)) and known[0] == clause.verb]
    nouns = [at for at, word in enumerate(said) if word in noun.split("_")]
    return bool(verbs and nouns) and nouns[0] < verbs[-1]


def in_text_order(clauses: Sequence[Clause], others: Iterable[Clause]) -> tuple[Clause, ...]:
    """Return clauses in the order of doing, with each of some others behind what the text says before it."""
    ordered = list(clauses)
    for other in others:
        before = (place for place, clause in enumerate(ordered, 1) if clause.span < other.span)
        ordered.insert(max(before, default=0), other)
    return tuple(ordered)


def _as_state(clause: Clause) -> Clause | None:
    """Return what a prohibition says of the state of things that it names; ``None`` where it says no such thing."""
    wished = clause.verb in section("wishing") or is_verb(clause.verb, "having")
    if clause.mood is not Mood.AVOID or not (wished or is_verb(clause.verb, "leaving")):
        return None
    if len(clause.direct) != 1 or clause.relations or is_pronoun(clause.direct[0]):
        return None
    phrase = clause.phrase(clause.direct[0])
    result = clause.result or next(iter(phrase.attributes if clause.implied else ()), None)
    if result is None:
        return None
    # "any gate", "a gate" and "no gate" are all of them
    quantifier = Quantifier.PLAIN if phrase.definite else Quantifier.ALL
    said = replace(phrase, quantifier=quantifier, attributes=phrase.attributes if clause.result else ())
    phrases = {**clause.phrases, phrase.name: said}
    return replace(clause, verb=BE, mood=Mood.DO, implied=False, result=f"{NEGATED}{result}", phrases=phrases)


def steps_of(parsed: Parsed, *, use: bool) -> tuple[RuleStep, ...]:
    """Return the steps of a request in the order of doing.

    Args:
        parsed: The request.
        use: Whether to *use* a thing only says what the clause beside it is done with.
    """
    clauses = _with_instruments(parsed) if use else parsed.clauses
    steps = _in_order(clauses)
    for clause in filter(is_of_the_end, parsed.constraints):
        before = [n for n, other in enumerate(parsed.clauses) if other.span.start < clause.span.start]
        steps = _with_end(steps, clause, before[-1] if before else 0)
    return tuple(_continued(step, parsed.clauses) for step in steps)


def _with_instruments(parsed: Parsed) -> tuple[Clause, ...]:
    """Return the clauses, with the object of a *use* as the instrument of the clause beside it.

    That is the next clause of the sentence (*use the pot to boil water*), or else the one before it (*heat the milk,
    use the microwave*).
    """
    clauses = list(parsed.clauses)
    for number, clause in enumerate(parsed.clauses):
        alone = clause.verb == USE and clause.mood is Mood.DO and len(clause.direct) == 1 and not clause.relations
        beside = (n for n in (number + 1, number - 1) if alone and 0 <= n < len(clauses))
        fitting = (n for n in beside if _same_sentence(parsed, clause, clauses[n]) and _takes_tool(clauses[n]))
        other = next(fitting, None)
        if other is not None:
            clauses[other] = _using(clauses[other], clause)
    return tuple(clauses)


def _takes_tool(clause: Clause) -> bool:
    named = any(is_relation(r.relation, "instrument") for r in clause.relations)
    return clause.mood is Mood.DO and clause.verb != USE and bool(clause.direct) and not named


def _same_sentence(parsed: Parsed, one: Clause, other: Clause) -> bool:
    first, second = sorted((one, other), key=lambda clause: clause.span)
    return _ENDS.isdisjoint(parsed.text[first.span.end : second.span.start])


def _using(done: Clause, use: Clause) -> Clause:
    """Return a clause with the object of a *use* as its instrument."""
    tool = use.direct[0]
    if tool in done.objects:
        return done
    relation = the_word("relations", "instrument")
    relations = (*done.relations, *(Relation(relation, direct, tool) for direct in done.direct))
    meant = {noun: tuple(n for n in names if n != tool) or names for noun, names in done.antecedents.items()}
    phrases = {**done.phrases, tool: use.phrase(tool)}
    return replace(done, objects=(*done.objects, tool), relations=relations, phrases=phrases, antecedents=meant)


def _with_end(steps: Sequence[RuleStep], clause: Clause, number: int) -> tuple[RuleStep, ...]:
    """Return the steps, and after those of a clause how things must not be left: *… and don't leave it open*."""
    place = max((at for at, step in enumerate(steps, 1) if step.number == number), default=len(steps))
    other = replace(clause, mood=Mood.DO, result=f"{NEGATED}{clause.result}")
    return (*steps[:place], RuleStep(other, number, main=False, direct=other.direct), *steps[place:])


def _continued(step: RuleStep, clauses: Sequence[Clause]) -> RuleStep:
    """Return a step with whether the next clause goes on with its things; to take them may then mean nothing here."""
    following = clauses[step.number + 1] if step.number + 1 < len(clauses) else None
    continued = following is not None and _goes_on(step, following)
    taken = continued and following is not None and _only_takes(step.clause, following)
    return replace(step, continued=continued, optional=step.optional or taken)


def _only_takes(clause: Clause, following: Clause) -> bool:
    """Return whether a clause only takes things that the next one moves: *get it from the box, put it on the shelf*."""
    away = all(is_relation(relation.relation, "origin") for relation in clause.relations)
    again = {noun for noun in following.direct if not set(clause.direct).isdisjoint(following.meant(noun))}
    moved = any(is_relation(r.relation, "place") and r.source in again for r in following.relations)
    takes = is_verb(clause.verb, "getting") and not clause.conditions
    return takes and (not clause.relations or (away and moved))


def _goes_on(step: RuleStep, following: Clause) -> bool:
    """Return whether the next clause goes on with what a step acts on: *pick up the boxes and put them in the bag*."""
    direct = set(step.direct)
    return following.mood is Mood.DO and any(direct & set(names) for names in following.antecedents.values())


def _in_order(clauses: Sequence[Clause]) -> tuple[RuleStep, ...]:
    """Return the steps of a text in the order of doing."""
    heading = next((clause for clause in clauses if clause.heading), None)
    if heading is not None and not heading.implied:
        taken = [c for c in clauses if c.implied and c is not heading and _takes_verb(c, heading)]
        clauses = [replace(c, verb=heading.verb) if c in taken else c for c in clauses]
    ordered = sorted(enumerate(clauses), key=lambda pair: pair[1].heading)
    details = [c for c in clauses if heading is not None and c is not heading and not _takes_verb(c, heading)]
    about = heading.direct[0] if heading is not None and details else ""
    return tuple(
        replace(step, explained=bool(about) and clause.heading, explains=about if clause in details else "")
        for number, clause in ordered
        for step in _steps(clause, number, summarises=not number and len(clauses) > _FEWEST)
    )


def _takes_verb(clause: Clause, heading: Clause) -> bool:
    """Return whether a clause may have the verb of its heading: not "clear the desk: the pen in the box"."""
    placed = any(r.source in clause.direct and is_relation(r.relation, "place") for r in clause.relations)
    return not (placed and heading.direct and is_verb(heading.verb, "summary"))


def _step(clause: Clause, number: int, owner: Clause, *, main: bool = True) -> RuleStep:
    """Return a step with the guards of the clause that it belongs to."""
    guards = tuple(condition for condition in owner.conditions if is_condition(condition.word, "guard"))
    return RuleStep(clause, number, main=main, direct=clause.direct, guards=guards, otherwise=owner.otherwise)


def _steps(clause: Clause, number: int, *, summarises: bool) -> Iterator[RuleStep]:
    """Yield the steps of a clause; ``summarises`` where enough follows that it may only be a heading."""
    if clause.mood is Mood.KEEP:
        step = _step(clause, number, clause)
        if clause.result and clause.result not in words_of("outcomes", "alone"):
            verb = clause.verb if all(map(is_pronoun, clause.direct)) else BE
            yield replace(step, clause=replace(clause, verb=verb, mood=Mood.DO), jointly=True)
        elif step.guards or any(is_relation(r.relation, "locating") for r in clause.relations):
            yield step  # "if it is there, leave it, otherwise …", "keep it where the other one is"
        return
    for _, inner in _said(clause, "earlier"):
        # "once it boils" is about what boils by then, if that is what is meant
        awaited = inner.verb == BE or any(map(is_pronoun, inner.direct))
        yield replace(_step(inner, number, clause, main=False), optional=True, awaited=awaited)
    summary = is_verb(clause.verb, "summary")
    optional = clause.heading or (summarises and summary)
    yield replace(_step(clause, number, clause), optional=optional, loose=optional and summary)
    if clause.duration and not is_verb(clause.verb.partition("_")[0], "waiting"):
        # "put the noodles in for three minutes" asks for what time brings about, where a domain says what that is
        waiting = Clause(the_word("verbs", "waiting"), span=clause.span, text=clause.text)
        yield replace(_step(waiting, number, clause, main=False), optional=True)
    for inner in _meanwhile(clause):
        yield _step(inner, number, clause, main=False)
    for word, inner in _said(clause, "later"):
        # "before you leave" says when, and is nothing to be done where nobody knows how
        optional = not is_condition(word, "needed") or is_verb(inner.verb, "parting")
        awaited, jointly = is_condition(word, "awaited"), is_condition(word, "joint")
        loose = is_condition(word, "loose")
        step = _step(inner, number, clause, main=False)
        yield replace(step, optional=optional, awaited=awaited, jointly=jointly, loose=loose)


def _meanwhile(clause: Clause) -> Iterator[Clause]:
    """Yield what shall be done meanwhile: "while you mop the hall"; not "while you are there", "while it boils"."""
    for condition in clause.conditions:
        asked = is_condition(condition.word, "meanwhile") and not condition.negated
        if asked and not section("addressee").isdisjoint(condition.text.lower().split()[:2]):
            yield from (inner for inner in condition.clauses if inner.verb != BE and inner.direct)


def _said(clause: Clause, kind: str) -> Iterator[tuple[str, Clause]]:
    """Yield the clauses of the conditions of a kind, each with the word that opens its condition."""
    said = (c for c in clause.conditions if is_condition(c.word, kind) and not c.negated)
    return ((condition.word, inner) for condition in said for inner in condition.clauses)
