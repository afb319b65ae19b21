"""Rank what pronouns and missing objects may mean, from the last few clauses.

The best simple rule on real instructions is the direct object of the nearest earlier clause that has one, with
agreement in number; nouns behind prepositions come after direct objects of the same clause, but before those of older
clauses. The reader that knows the environment picks from the list.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from functools import reduce
from typing import NamedTuple

from tmd.language.clause import AGENT, BE, EXCEPT, OF, PERSONS, TO, Clause, Condition, Mood, Quantifier, Relation
from tmd.language.lexicon.lexicon import pairs, section, sections_of
from tmd.language.syntax.drafts import ClauseDraft
from tmd.language.syntax.noun_phrases import Phrase
from tmd.language.syntax.reading import TextReading, denies
from tmd.language.syntax.tokens import IMPLIED

_REACH = 5
"""Clauses that a pronoun looks back."""
_AGE, _PART, _LANDMARK, _COORDINATED = 4, 2, 1, 1
"""Penalties of a mention: per clause of age, under "of", behind a preposition, in a coordination."""
_REPLACEMENT = -1
"""Penalty of what came in the place of something else."""


class _Mention(NamedTuple):
    """A thing that was mentioned, its distance from the verb, and its distinguishing words."""

    name: str
    plural: bool
    penalty: int
    described: bool = False
    behind: str = ""
    """The preposition before it."""


class _Scene(NamedTuple):
    """The mentions of one clause, for later ones; ``together`` are its direct objects; where it stands in the text."""

    mentions: tuple[_Mention, ...]
    together: tuple[str, ...]
    at: int = 0


def is_one(name: str) -> bool:
    """Return whether a language-object is *one*, or *red_one*: one of the things mentioned."""
    return name.rpartition("_")[2] in section("one_words")


def is_pronoun(name: str) -> bool:
    """Return whether a language-object refers to something mentioned before."""
    pronouns = ("singular_pronouns", "plural_pronouns", "open_pronouns", "there_pronouns")
    return not sections_of(name).isdisjoint(pronouns) or is_one(name)


def _is_single(pronoun: str) -> bool:
    return not sections_of(pronoun).isdisjoint(("singular_pronouns", "there_pronouns"))


def resolve(reading: TextReading) -> tuple[tuple[Clause, ...], tuple[Clause, ...], tuple[Clause, ...]]:
    """Return the clauses, what must not be done, and what is only stated, with their antecedents filled in."""
    scenes: list[_Scene] = []
    clauses: list[Clause] = []
    facts: dict[str, Clause] = {}
    stated: list[Clause] = []
    statements = sorted([*reading.statements, *reading.forbidden], key=lambda said: said[0])
    hosted: dict[int, list[ClauseDraft]] = {}
    for draft in reading.drafts:
        hosted.setdefault(id(draft.host), []).append(draft)

    def tell(last: int) -> None:
        """Take up what is stated before a clause."""
        while statements and statements[0][0] <= last:
            said = statements.pop(0)[1]
            fact = _resolved(said.clause(reading.text), said, scenes)
            contrast = said.mood is Mood.AVOID and said.verb.form == IMPLIED  # "the film instead of the game"
            scenes.insert(max(len(scenes) - contrast, 0), _scene(said, fact))
            facts.update(_new(fact, clauses))
            stated.append(fact)

    for index, draft in enumerate(reading.drafts):
        tell(index)
        clause = _with_conditions(draft.clause(reading.text), draft, scenes)
        conditions = clause.conditions
        scenes += [_alone(c) for condition in conditions if condition.word != TO for c in condition.clauses]
        hosts = [draft.host] if draft.host is not None else []
        hosts += [d for d in hosted.get(id(draft), ()) if d.verb.span < draft.verb.span]  # "before closing it"
        # of "boil it (wash the pot first)" the pot is done first, and mentioned later
        known = [scene for scene in scenes if scene.at <= draft.verb.span.start] or scenes
        clause = _resolved(clause, draft, [*known, *(_scene(host, host.clause(reading.text)) for host in hosts)])
        clause = reduce(_spelled_out, facts.values(), clause)
        clause = replace(clause, stated=(*clause.stated, *_stated(clause, facts)))
        clauses.append(_missing_state(clause))
        scenes.append(_scene(draft, clause))
    tell(len(reading.drafts))
    forbidden = [resolve_alone(draft.clause(reading.text), clauses[:before]) for before, draft in reading.forbidden]
    return tuple(clauses), tuple(forbidden), tuple(stated)


def _spelled_out(clause: Clause, known: Clause) -> Clause:
    """Return a clause with a pronoun replaced by what another clause calls its antecedent: "the gate of pen 3"."""
    for pronoun in filter(section("singular_pronouns").__contains__, clause.objects):
        noun = clause.antecedents.get(pronoun, ("",))[0]
        phrase = known.phrase(noun)
        wholes = tuple(r for r in known.relations if r.source == noun and r.relation == OF)
        renamed = clause.renamed(pronoun, noun)
        single = noun in known.direct and phrase.definite and not phrase.plural and renamed is not clause
        if single and (wholes or phrase.attributes):
            clause = replace(
                renamed,
                objects=tuple(dict.fromkeys((*renamed.objects, *(r.target for r in wholes)))),
                relations=(*renamed.relations, *wholes),
                antecedents={name: meant for name, meant in renamed.antecedents.items() if name != noun},
                phrases={**renamed.phrases, noun: phrase},
            )
    return clause


def _missing_state(clause: Clause) -> Clause:
    """Return what "do it" asks for behind a condition: the state that it denies, "if the gate isn't shut, do it"."""
    missing = [said for condition in filter(denies, clause.conditions) for said in condition.clauses]
    vague = clause.verb in section("pro_verbs") and not clause.relations and all(map(is_pronoun, clause.direct))
    if not vague or len(missing) != 1:
        return clause
    return replace(
        missing[0],
        span=clause.span,
        text=clause.text,
        condition=clause.condition,
        conditions=clause.conditions,
        otherwise=clause.otherwise,
    )


def _resolved(clause: Clause, draft: ClauseDraft, scenes: list[_Scene]) -> Clause:
    places = [name for name in clause.objects if is_pronoun(name) or name in section("animate")]
    if _elides(clause, draft):
        places.append("")
    antecedents, together = {}, {}
    for pronoun in places:
        ranked, count = _meanings(pronoun, clause, draft, scenes)
        if ranked:
            antecedents[pronoun], together[pronoun] = ranked, count
    return replace(clause, antecedents=antecedents, together=together, relations=_without_kinds(clause, antecedents))


def _meanings(pronoun: str, clause: Clause, draft: ClauseDraft, scenes: list[_Scene]) -> tuple[tuple[str, ...], int]:
    """Return what a pronoun of a clause may mean, likeliest first, and how many of them it means."""
    before = {r.relation for r in clause.relations if r.target == pronoun}
    ranked, count = _rank(pronoun, draft, scenes, before)
    if is_one(pronoun):
        taken_from = (r.source for r in clause.relations if r.relation == EXCEPT and r.target == pronoun and r.source)
        ranked = tuple(dict.fromkeys((*taken_from, *_one(pronoun, ranked, clause, draft, before))))
        count = 1
        ranked = _in_order(pronoun, scenes) or ranked
    elif _is_single(pronoun):
        vessels = _vessels(pronoun, clause, draft) if not before.isdisjoint(section("insides")) else []
        ranked = tuple(dict.fromkeys((*vessels, *_things_before(pronoun, clause), *ranked)))
    return _places_first(pronoun, ranked, clause, scenes), count


def _places_first(pronoun: str, ranked: tuple[str, ...], clause: Clause, scenes: Sequence[_Scene]) -> tuple[str, ...]:
    """Return what "in there", or "in it" of a relative clause, may mean: first what was named as a place."""
    if pronoun not in section("there_pronouns") and all(r.target != pronoun for r in clause.stated):
        return ranked
    places = {m.name for scene in scenes[-_REACH:] for m in scene.mentions if m.behind}
    return tuple(sorted(ranked, key=lambda name: name not in places))


def _without_kinds(clause: Clause, antecedents: Mapping[str, Sequence[str]]) -> tuple[Relation, ...]:
    """Return the relations without what *one* is one of: "of the two pots, wash the one on the bench"."""
    ones = {name: antecedents[name][:1] for name in antecedents if is_one(name)}
    return tuple(r for r in clause.relations if r.relation != OF or r.target not in ones.get(r.source or "", ()))


def _elides(clause: Clause, draft: ClauseDraft) -> bool:
    """Return whether what a clause acts on may be left out: "put on the table" as well, if nothing is called so."""
    verb, _, particle = clause.verb.partition("_")
    ahead = any(part.start < phrase.place for part in draft.verb.parts for phrase in draft.direct[:1])
    placed = verb in section("placing") and particle in section("static") and ahead
    return placed or not (draft.direct or clause.verb in section("intransitive"))


def _new(fact: Clause, before: Sequence[Clause]) -> dict[str, Clause]:
    """Return a statement by the nouns that it mentions first; a prohibition states nothing."""
    known = {name for clause in before for name in _named(clause)}
    stated = (fact.verb == BE or fact.verb in section("postures")) and fact.mood is not Mood.AVOID
    return {name: fact for name in fact.direct if stated and name not in known}


def _stated(clause: Clause, facts: dict[str, Clause]) -> tuple[Relation, ...]:
    """Return where statements say that the things of a clause are.

    A statement says which thing is meant when it is next mentioned; from then on, the text binds it.
    """
    found: list[Relation] = []
    mentioned = [(name, meant) for name in (*clause.objects, "") for meant in clause.meant(name)]
    for name, meant in mentioned:
        fact = facts.pop(meant, None)
        several = fact is not None and _is_of_several(fact, meant, name, clause)
        places = fact.relations if fact is not None and not several else ()
        meanings = fact.antecedents if fact is not None else {}  # "there is a sock on it"
        told = [r for r in places if r.source == meant and r.relation in section("static")]
        found += [r._replace(target=meanings.get(r.target, (r.target,))[0]) for r in told]
    return tuple(r for r in found if r.target not in clause.objects and not is_pronoun(r.target))


def _is_of_several(fact: Clause, meant: str, name: str, clause: Clause) -> bool:
    """Return whether a statement is about one of several things that are meant.

    *There is a sock on the floor and one on the bed. Put both away.*
    """
    alone = clause.together.get(name, 1) == 1 and not fact.phrase(meant).plural
    return alone and name in section("plural_pronouns")


def _place(pronoun: str, draft: ClauseDraft) -> int:
    """Return where a pronoun stands; one in a relative clause counts as standing at the verb."""
    return next((p.place for p in draft.mentions() if p.name == pronoun), draft.verb.span.start)


def _things_before(pronoun: str, clause: Clause) -> list[str]:
    """Return what a clause acts on before what it puts beside a pronoun: "the mug here and the spoon next to it"."""
    sources = {r.source for r in clause.relations if r.target == pronoun}
    first = next((at for at, name in enumerate(clause.direct) if name in sources), 0)
    things = clause.direct[:first]
    return [name for name in (*things, *(r.target for r in clause.relations if r.source in things)) if _is_name(name)]


def _vessels(pronoun: str, clause: Clause, draft: ClauseDraft) -> list[str]:
    """Return what the clause itself mentions as a vessel: "coffee in a mug, and some ice cream in it"."""
    vessels = {r.target for r in clause.relations if r.relation in section("insides")}
    place = _place(pronoun, draft)
    return [p.name for p in draft.mentions() if p.place < place and p.name in vessels and not p.pronoun]


def _told(phrase: Phrase) -> bool:
    return bool(phrase.said().attributes) or "_" in phrase.name


def _one(
    pronoun: str, ranked: tuple[str, ...], clause: Clause, draft: ClauseDraft, before: Collection[str]
) -> tuple[str, ...]:
    """Rank what *one* may be one of: what the clause itself mentions before comes first.

    Of that, what stands behind the same preposition ("the chips in one bowl and the nuts in the other"), then what
    is distinguished; before all, the place that a thing is moved from where *one* is the place that it goes to.
    """
    own = _own(pronoun, clause, draft, before, apart=bool(before and ranked))
    goes = not section("arrivals").isdisjoint(before)
    left = [r.target for r in clause.relations if goes and r.relation in section("origins")]
    plain = pronoun in section("one_words")
    own = own[:1] if plain else own
    # "put the pillow from the floor on the sofa, and do the same with the other one": that is no floor
    alone = clause.direct == (pronoun,)
    names = tuple(dict.fromkeys((*left[:1], *((*ranked, *own) if alone else (*own, *ranked)))))
    return names if plain else tuple(dict.fromkeys(name.rpartition("_")[2] for name in names))


def _in_order(pronoun: str, scenes: Sequence[_Scene]) -> tuple[str, ...]:
    """Return what *the former* or *the second* means of several things mentioned together."""
    place = pairs("places_in_order").get(pronoun.partition("_")[0])
    group = _group(list(scenes[-_REACH:][::-1]), set()) if place is not None else ()
    return (group[int(place)],) if place is not None and 1 < len(group) > int(place) else ()


def _own(pronoun: str, clause: Clause, draft: ClauseDraft, before: Collection[str], *, apart: bool) -> list[str]:
    """Return what a clause mentions before *one*, likeliest first; where ``apart``, only what is distinguished."""
    alike = {r.target for r in clause.relations if r.relation in before}
    own = [p for p in draft.mentions() if p.place < _place(pronoun, draft) and not p.pronoun]
    own = [p for p in own if not apart or p.name in alike or _told(p)]
    acted_on = {p.name for p in draft.direct} if pronoun in clause.direct else set()  # "and another on the chair"

    def rank(phrase: Phrase) -> tuple[bool, bool, bool]:
        beside = phrase.name not in acted_on and bool(acted_on)
        return phrase.name not in alike, beside, not (phrase.plural or _told(phrase))

    return [phrase.name for phrase in sorted(own, key=rank)]


def resolve_alone(clause: Clause, before: Sequence[Clause]) -> Clause:
    """Return a separate clause with its pronouns' antecedents among the clauses before it."""
    names = list(dict.fromkeys(name for c in before[::-1] for name in _named(c)))
    places = [name for name in clause.objects if is_pronoun(name) or name in section("animate")]
    telling = {n for c in before for n, said in c.phrases.items() if said.attributes or said.plural}
    ranked = {pronoun: _ranked_alone(pronoun, names, telling, clause, before) for pronoun in places}
    antecedents = {name: tuple(found) for name, found in ranked.items() if found}
    return replace(clause, antecedents=antecedents, together=dict.fromkeys(antecedents, 1))


def _ranked_alone(
    pronoun: str, names: list[str], telling: Collection[str], clause: Clause, before: Sequence[Clause]
) -> list[str]:
    """Rank what a pronoun of a separate clause may mean: "into the mug, not into the other one" is about mugs."""
    if not is_one(pronoun):
        return names
    behind = {r.relation for r in clause.relations if r.target == pronoun}
    alike = {r.target for c in before for r in c.relations if r.relation in behind}
    told = sorted(names, key=lambda name: (name not in alike, name not in telling))
    return told if pronoun in section("one_words") else list(dict.fromkeys(name.rpartition("_")[2] for name in told))


def _named(clause: Clause) -> list[str]:
    """Return the names in a clause, first those that it acts on."""
    names = [n for name in (*clause.direct, *clause.objects) for n in clause.meant(name)]
    return [name for name in dict.fromkeys(names) if name and not is_pronoun(name) and name not in section("pronouns")]


def _with_conditions(clause: Clause, draft: ClauseDraft, scenes: list[_Scene]) -> Clause:
    found: list[Condition] = []
    for condition in clause.conditions:
        earlier = [_alone(said) for before in found for said in before.clauses]
        found.append(_condition(condition, draft, clause, [*scenes, *earlier]))
    return replace(clause, conditions=tuple(found))


def _condition(condition: Condition, draft: ClauseDraft, owner: Clause, scenes: list[_Scene]) -> Condition:
    """Return a condition with the antecedents of its pronouns: from the clauses before, or from its own."""
    ahead = () if draft.fronted else tuple(p.name for p in draft.direct if not p.pronoun)
    recent = [name for name, _ in _scored(scenes[-_REACH:][::-1], set(), draft)]
    behind = tuple(p.name for p in draft.mentions() if not p.pronoun)
    many = _several(draft, scenes)
    names = tuple(dict.fromkeys([*ahead, *recent, *behind]))
    # "break the egg into it once it boils": one and the same
    same = {p.name: tuple(dict.fromkeys([*recent, *names])) for p in draft.mentions() if p.pronoun}
    moved = ahead if draft.verb.stem.partition("_")[0] in section("moving") else ()
    elsewhere = tuple(sorted(names, key=lambda name: name in moved))  # "put the disc in if there is nothing in it"

    def filled(clause: Clause) -> Clause:
        own = [n for n in clause.objects if is_pronoun(n)]
        holding = _holding(clause)
        found = {n: _agreeing(n, elsewhere if n in holding else same.get(n, names), many) for n in own if names}
        clause = replace(
            clause, antecedents={**clause.antecedents, **found}, together={**clause.together, **dict.fromkeys(own, 1)}
        )
        return clause if draft.fronted else _spelled_out(clause, owner)

    return replace(condition, clauses=tuple(filled(clause) for clause in condition.clauses))


def _several(draft: ClauseDraft, scenes: list[_Scene]) -> set[str]:
    """Return the plural nouns of a clause and of the scenes before it."""
    recent = {m.name for scene in scenes[-_REACH:] for m in scene.mentions if m.plural}
    return recent | {p.name for p in draft.mentions() if p.plural}


def _holding(clause: Clause) -> set[str]:
    """Return the nouns of which a clause says what is in them."""
    inner = (r for r in clause.relations if r.relation in section("insides"))
    return {r.target for r in inner if r.source and not is_pronoun(r.source)}


def _agreeing(pronoun: str, names: tuple[str, ...], many: Collection[str]) -> tuple[str, ...]:
    """Return the names with those first that agree with a pronoun in number."""
    plural = pronoun in section("plural_pronouns")
    if not (plural or pronoun in section("singular_pronouns")):
        return names
    return tuple(sorted(names, key=lambda name: (name in many) != plural))


def _alone(clause: Clause) -> _Scene:
    """Return what a subordinate clause leaves behind."""
    names = _named(clause)
    direct = [n for name in clause.direct for n in clause.meant(name)]
    mentions = tuple(_Mention(name, clause.phrase(name).plural, 0 if name in direct else _LANDMARK) for name in names)
    return _Scene(mentions, tuple(n for n in names if n in direct), clause.span.start)


def _rank(
    pronoun: str, draft: ClauseDraft, scenes: list[_Scene], before: Collection[str]
) -> tuple[tuple[str, ...], int]:
    """Return the candidates, likeliest first, and how many of the first are meant together.

    ``before`` are the prepositions that the pronoun stands behind.
    """
    recent = scenes[-_REACH:][::-1]
    own = {p.name for p in draft.mentions()}
    scored = _scored(recent, own, draft)
    group: tuple[str, ...] = ()
    if pronoun in section("plural_pronouns"):
        group = _group(recent, own)
    elif pronoun == "" and recent:
        group = tuple(name for name in recent[0].together if name not in own)
    if group:
        return (*group, *(name for name, _ in scored if name not in group)), len(group)
    return tuple(name for name, _ in _fitting(pronoun, scored, recent, before)), 1


def _fitting(
    pronoun: str, scored: list[tuple[str, int]], recent: list[_Scene], before: Collection[str]
) -> list[tuple[str, int]]:
    """Return the candidates with those first, or those only, that fit the pronoun."""
    mentions = [m for scene in recent for m in scene.mentions]
    plural = {m.name for m in mentions if m.plural}
    if is_one(pronoun):  # "the book and the empty can … the full one": a distinguished thing, or one of many
        telling = plural | {m.name for m in mentions if m.described}
        alike = {m.name for m in mentions if m.behind and m.behind in before}
        return sorted(scored, key=lambda pair: (pair[0] not in alike, pair[0] not in telling))
    single = [pair for pair in scored if pair[0] not in plural]
    return single if _is_single(pronoun) and single else scored


def _group(recent: list[_Scene], own: set[str]) -> tuple[str, ...]:
    """Return what *them* means together: several objects of one clause, else those of the last two."""
    for scene in recent:
        group = tuple(name for name in scene.together if name not in own)
        if group and (len(group) > 1 or any(m.plural and m.name == group[0] for m in scene.mentions)):
            return group
    pair = [name for scene in recent[:2][::-1] for name in scene.together if name not in own]
    return tuple(dict.fromkeys(pair))


def _scored(recent: list[_Scene], own: set[str], draft: ClauseDraft) -> list[tuple[str, int]]:
    """Return the names of recent mentions with their least penalty, least first."""
    best: dict[str, int] = {}
    moving = draft.verb.stem in section("moving")
    for age, scene in enumerate(recent):
        for mention in scene.mentions:
            if mention.name in own:
                continue
            mass = _AGE * _REACH if moving and mention.name.rpartition("_")[2] in section("mass") else 0
            score = _AGE * age + mention.penalty + mass
            best[mention.name] = min(score, best.get(mention.name, score))
    return sorted(best.items(), key=lambda pair: pair[1])


def _scene(draft: ClauseDraft, clause: Clause) -> _Scene:
    """Return what a clause leaves behind."""
    direct = [p for p in draft.direct if p.name not in PERSONS]
    elided = clause.antecedents.get("", ())[: clause.together.get("", 1)]
    spread = _COORDINATED if len(direct) > 1 else 0
    mentions = [_Mention(name, False, 0) for name in elided]
    mentions += [m for phrase in direct for m in _acted_on(phrase, clause, spread)]
    mentions += [m for landmark in draft.landmarks for m in _landmark(landmark, clause)]
    several = _acting(draft, clause) or direct
    together = [*(name for phrase in several for name in _meant(phrase, clause)), *elided]
    named = tuple(m for m in mentions if _is_name(m.name))
    return _Scene(named, tuple(dict.fromkeys(filter(_is_name, together))), draft.verb.span.start)


def _acting(draft: ClauseDraft, clause: Clause) -> list[Phrase]:
    """Return several things that do or get something together: "give the fern and the ivy a drop each"."""
    agents = {r.target for r in clause.relations if r.relation in (AGENT, TO)}
    acting = [p for p in draft.landmarks if p.name in agents]
    return acting if len(acting) > 1 else []


def _is_name(name: str) -> bool:
    return not is_pronoun(name) and name not in section("pronouns")


def _acted_on(phrase: Phrase, clause: Clause, spread: int) -> list[_Mention]:
    """Return what a direct object mentions, farther where it is one of several."""
    many = phrase.plural or phrase.name in section("plural_pronouns")
    own = [_Mention(name, many, spread, _told(phrase)) for name in _meant(phrase, clause)]
    return own + [_Mention(p.name, p.plural, _PART + spread) for p in phrase.all() if p is not phrase]


def _landmark(landmark: Phrase, clause: Clause) -> list[_Mention]:
    """Return what a prepositional phrase mentions."""
    found = []
    for part in landmark.all():
        behind = next((r.relation for r in clause.relations if r.target == part.name), "")
        distance = _LANDMARK + _PART * (part is not landmark)
        if clause.verb in section("replacing") | section("mutual_verbs") and behind in section("replacement"):
            distance = _REPLACEMENT
        each = part.said().quantifier is Quantifier.ALL  # "into each cup, but leave the full one"
        found += [_Mention(name, part.plural, distance, each, behind) for name in _meant(part, clause)]
    return found


def _meant(phrase: Phrase, clause: Clause) -> list[str]:
    if not phrase.pronoun or phrase.name in section("whole_words"):
        return [phrase.name]
    return list(clause.antecedents.get(phrase.name, ())[: clause.together.get(phrase.name, 1)])
