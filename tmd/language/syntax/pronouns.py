"""What pronouns and missing objects may mean: a ranked list from the last few clauses.

The best simple rule on real instructions is the direct object of the nearest earlier clause that has one,
with agreement in number; nouns behind prepositions come after direct objects of the same clause, but before
those of older clauses. Whoever knows the environment picks from the list.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

from tmd.language.clause import PERSONS, Clause, Condition
from tmd.language.lexicon.lexicon import section, singular
from tmd.language.syntax.attachment import ClauseDraft, Phrase
from tmd.language.syntax.tokens import Kind, Token

SINGULAR = frozenset({"it", "this", "that", "itself"})
PLURAL = frozenset({"them", "they", "these", "those", "both", "themselves"})
_LEAVING = frozenset({"from", "off", "out_of"})
_ARRIVING = frozenset({"to", "into", "onto", "in", "on"})
_INSIDE = frozenset({"in", "into", "inside"})
OPEN = frozenset({"one", "some", "all", "each", "any", "half", "most", ""})
"""Pronouns without number ("ones" is named ``one``); the empty name is an elided object."""

_REACH = 5
_AGE, _PART, _LANDMARK, _COORDINATED = 4, 2, 1, 1


@dataclass(frozen=True, slots=True)
class _Mention:
    """A thing that was spoken of, with how far it stands from the verb, and whether an adjective told which one."""

    name: str
    plural: bool
    penalty: int
    described: bool = False
    behind: str = ""
    """The preposition before it."""


@dataclass(frozen=True, slots=True)
class _Scene:
    """What one clause leaves behind for later ones."""

    mentions: tuple[_Mention, ...]
    together: tuple[str, ...]
    """Its direct objects, if they can be meant by a plural pronoun."""


def resolve(drafts: Sequence[ClauseDraft], text: str, statements: Sequence[Token] = ()) -> tuple[Clause, ...]:
    """Return the clauses with their antecedents filled in.

    Args:
        drafts: The clauses, in order.
        text: The text.
        statements: What was folded as no instruction; pronouns may mean the things in it: *these are old, bin them*.
    """
    scenes: list[_Scene] = []
    clauses = []
    waiting = list(statements)
    for draft in drafts:
        while waiting and waiting[0].span < draft.verb.span:
            scenes.append(_stated(waiting.pop(0)))
        clause = draft.clause(text)
        conditions = tuple(_condition(c, draft, scenes) for c in clause.conditions)
        clause = replace(clause, conditions=conditions)
        scenes += [_alone(c) for condition in conditions if condition.word != "to" for c in condition.clauses]
        antecedents, together = {}, {}
        for pronoun in _open_places(draft, clause):
            before = {r.relation for r in clause.relations if r.target == pronoun}
            ranked, count = _rank(pronoun, draft, scenes, before)
            if pronoun in SINGULAR and before & _INSIDE:
                # "coffee in a mug, and some ice cream in it": in what the clause itself spoke of as a vessel
                at = next((p.place for p in draft.mentions() if p.name == pronoun), 0)
                vessels = {r.target for r in clause.relations if r.relation in _INSIDE}
                ahead = [p.name for p in draft.mentions() if p.place < at and p.name in vessels and not p.pronoun]
                ranked = tuple(dict.fromkeys((*ahead, *ranked)))
            if is_one(pronoun):
                # "the red block on the blue one": one of what the clause itself spoke of before
                places = (p.place for p in draft.mentions() if p.name == pronoun)
                place = next(places, draft.verb.span.start)  # it may stand in a relative clause
                own = [p for p in draft.mentions() if p.place < place and not p.pronoun]
                if len(scenes) > 0 and before and ranked:  # "the chips into the bowl and peanuts into the other one"
                    spoken = {r.target for r in clause.relations if r.relation in before}
                    own = [p for p in own if p.name in spoken or p.said().attributes or "_" in p.name]
                # "the peanuts in one bowl and the chips in the other": what stands behind the same preposition
                behind = {r.relation for r in clause.relations if r.target == pronoun}
                alike = {r.target for r in clause.relations if r.relation in behind}
                own.sort(key=lambda p: (p.name not in alike, not (p.plural or p.said().attributes or "_" in p.name)))
                # "from the left shelf to the right one": a place, as that from where it goes
                goes = any(r.target == pronoun and r.relation in _ARRIVING for r in clause.relations)
                left = [r.target for r in clause.relations if goes and r.relation in _LEAVING]
                ranked, count = tuple(dict.fromkeys((*left[:1], *(p.name for p in own[:1]), *ranked))), 1
                if pronoun != "one":
                    ranked = tuple(dict.fromkeys(name.rpartition("_")[2] for name in ranked))
            if ranked:
                antecedents[pronoun], together[pronoun] = ranked, count
        clause = replace(clause, antecedents=antecedents, together=together)
        clauses.append(clause)
        scenes.append(_scene(draft, clause))
    return tuple(clauses)


def _stated(statement: Token) -> _Scene:
    """What a statement leaves behind: what it is about, and the nouns behind prepositions after that."""
    mentions: list[_Mention] = []
    words: list[Token] = []
    placed = False
    for token in [*statement.inner, None]:
        numbered = token is not None and token.kind is Kind.NUM and bool(words)  # "channel four"
        if token is not None and (token.kind is Kind.N or numbered):
            words.append(token)
        elif words:
            name = "_".join([*(t.text for t in words[:-1]), singular(words[-1].text)])
            if name not in PERSONS:
                many = singular(words[-1].text) != words[-1].text
                mentions.append(_Mention(name, many, _LANDMARK if placed else 0))
            words = []
        if token is not None and token.kind in (Kind.P, Kind.CC, Kind.COMMA):
            placed = token.kind is Kind.P
    return _Scene(tuple(mentions), tuple(m.name for m in mentions if not m.penalty))


def resolve_alone(clause: Clause, before: Sequence[Clause]) -> Clause:
    """Return a clause that stands for itself with its pronouns' antecedents among the clauses before it."""
    names = list(dict.fromkeys(name for c in before[::-1] for name in _named(c)))
    places = [name for name in clause.objects if is_pronoun(name)]
    telling = {n for c in before for n, said in c.phrases.items() if said.attributes or said.plural}
    told = sorted(names, key=lambda name: name not in telling)
    antecedents = {name: tuple(told if is_one(name) else names) for name in places if names}
    return replace(clause, antecedents=antecedents, together=dict.fromkeys(antecedents, 1))


def _named(clause: Clause) -> list[str]:
    """What a clause speaks of by name, what it acts on first."""
    names = [n for name in (*clause.direct, *clause.objects) for n in clause.meant(name)]
    return [name for name in dict.fromkeys(names) if name and not is_pronoun(name) and name not in section("pronouns")]


def _condition(condition: Condition, draft: ClauseDraft, scenes: list[_Scene]) -> Condition:
    """A condition with the antecedents of its pronouns: from the clauses before, or from its own."""
    ahead = () if draft.fronted else tuple(p.name for p in draft.direct if not p.pronoun)
    recent = [name for name, _ in _scored(scenes[-_REACH:][::-1], set(), draft)]
    behind = tuple(p.name for p in draft.mentions() if not p.pronoun)
    many = {m.name for scene in scenes[-_REACH:] for m in scene.mentions if m.plural}
    many |= {p.name for p in draft.mentions() if p.plural}
    names = tuple(dict.fromkeys([*ahead, *recent, *behind]))
    # "break the egg into it once it boils": one and the same
    same = {p.name: tuple(dict.fromkeys([*recent, *names])) for p in draft.mentions() if p.pronoun}
    clauses = tuple(
        replace(
            clause,
            antecedents={
                **clause.antecedents,
                **{n: _agreeing(n, same.get(n, names), many) for n in clause.objects if is_pronoun(n) and names},
            },
            together={**clause.together, **{n: 1 for n in clause.objects if is_pronoun(n)}},
        )
        for clause in condition.clauses
    )
    return replace(condition, clauses=clauses)


def _agreeing(pronoun: str, names: tuple[str, ...], many: Collection[str]) -> tuple[str, ...]:
    """The names with those first that agree with a pronoun in number."""
    if pronoun not in SINGULAR | PLURAL:
        return names
    return tuple(sorted(names, key=lambda name: (name in many) != (pronoun in PLURAL)))


def _alone(clause: Clause) -> _Scene:
    """What a subordinate clause leaves behind."""
    names = _named(clause)
    direct = [n for name in clause.direct for n in clause.meant(name)]
    mentions = tuple(_Mention(name, clause.phrase(name).plural, 0 if name in direct else _LANDMARK) for name in names)
    return _Scene(mentions, tuple(n for n in names if n in direct))


def is_pronoun(name: str) -> bool:
    """Tell whether a language-object stands for something said before."""
    return bool(name) and (name in SINGULAR | PLURAL | OPEN or is_one(name))


def is_one(name: str) -> bool:
    """Tell whether a language-object is *one*, or *red_one*: one of what was spoken of."""
    return name == "one" or name.endswith("_one")


def _open_places(draft: ClauseDraft, clause: Clause) -> list[str]:
    places = [name for name in clause.objects if is_pronoun(name)]
    if not draft.direct and clause.verb not in section("intransitive"):
        places.append("")
    return places


def _rank(
    pronoun: str, draft: ClauseDraft, scenes: list[_Scene], before: Collection[str] = ()
) -> tuple[tuple[str, ...], int]:
    """Return the candidates, likeliest first, and how many of the first are meant together.

    ``before`` are the prepositions that the pronoun stands behind.
    """
    recent = scenes[-_REACH:][::-1]
    own = {p.name for p in draft.mentions()}
    if pronoun in PLURAL:
        group = _group(recent, own)
        if group:
            others = [name for name, _ in _scored(recent, own, draft) if name not in group]
            return (*group, *others), len(group)
    scored = _scored(recent, own, draft)
    if is_one(pronoun):  # "the book and the empty can … the full one": what was told apart, or one of many
        telling = {m.name for s in recent for m in s.mentions if m.described or m.plural}
        alike = {m.name for s in recent for m in s.mentions if m.behind and m.behind in before}
        scored.sort(key=lambda pair: (pair[0] not in alike, pair[0] not in telling))
    if pronoun in SINGULAR:
        plural = {m.name for s in recent for m in s.mentions if m.plural}
        scored = [pair for pair in scored if pair[0] not in plural] or scored
    names = tuple(name for name, _ in scored)
    if pronoun == "" and recent and recent[0].together:
        group = tuple(name for name in recent[0].together if name not in own)
        if group:
            return (*group, *(n for n in names if n not in group)), len(group)
    return names, 1


def _group(recent: list[_Scene], own: set[str]) -> tuple[str, ...]:
    for scene in recent:
        group = tuple(name for name in scene.together if name not in own)
        if group and (len(group) > 1 or any(m.plural and m.name == group[0] for m in scene.mentions)):
            return group
    pair = [name for scene in recent[:2][::-1] for name in scene.together if name not in own]
    return tuple(dict.fromkeys(pair))


def _scored(recent: list[_Scene], own: set[str], draft: ClauseDraft) -> list[tuple[str, int]]:
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
    direct = [p for p in draft.direct if p.name != "me"]
    spread = _COORDINATED if len(direct) > 1 else 0
    mentions: list[_Mention] = []
    together: list[str] = []
    for phrase in direct:
        names = _meant(phrase, clause)
        together.extend(names)
        described = bool(phrase.said().attributes) or "_" in phrase.name
        mentions.extend(_Mention(name, phrase.plural or phrase.name in PLURAL, spread, described) for name in names)
        mentions.extend(_Mention(p.name, p.plural, _PART + spread) for p in phrase.all() if p is not phrase)
    for name in clause.antecedents.get("", ())[: clause.together.get("", 1)]:
        together.append(name)
        mentions.append(_Mention(name, False, 0))
    for landmark in draft.landmarks:
        for part in landmark.all():
            names = _meant(part, clause)
            behind = next((r.relation for r in clause.relations if r.target == part.name), "")
            distance = _LANDMARK + _PART * (part is not landmark)
            mentions.extend(_Mention(name, part.plural, distance, behind=behind) for name in names)
    named = tuple(m for m in mentions if not is_pronoun(m.name) and m.name not in section("pronouns"))
    return _Scene(named, tuple(dict.fromkeys(n for n in together if not is_pronoun(n))))


def _meant(phrase: Phrase, clause: Clause) -> list[str]:
    if not phrase.pronoun:
        return [phrase.name]
    return list(clause.antecedents.get(phrase.name, ())[: clause.together.get(phrase.name, 1)])
