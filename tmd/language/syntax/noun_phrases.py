"""Noun phrases: their names, numbers, determiners and modifiers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cache

from lark import Tree

from tmd.language.clause import PERSONS, NounPhrase, Quantifier
from tmd.language.lexicon.lexicon import first_of, pairs, section, sections, singular
from tmd.language.syntax.brackets import ALSO
from tmd.language.syntax.grammar import CHOICE, Leaf, Node, leaves, trees
from tmd.language.syntax.tokens import NAME, Kind, Token


def number_of(word: str) -> int | None:
    """Return the number that a word or numeral names, up to twelve in words."""
    if word.isascii() and word.isdigit() and len(word) < 10:
        return int(word)
    order, word = sections()["number_order"], pairs("counts").get(word, word)
    return order.index(word) if word in order else None


def is_number(word: str) -> bool:
    """Return whether a word is a number, in figures or in words."""
    return word[:1].isdigit() or word in section("numbers")


@dataclass(slots=True)
class Phrase:
    """A noun phrase.

    Attributes:
        name: The name of its head with its modifiers.
        place: Where it begins in the text.
        plural: Whether it is plural.
        pronoun: Whether its head is one.
        quantity: Its number as written.
        of: What hangs on it with "of".
        lead: The words before the head.
        either: The names of which any will do.
        attributes: Adjectives behind it.
    """

    name: str
    place: int
    plural: bool
    pronoun: bool
    quantity: str = ""
    of: list[Phrase] = field(default_factory=list)
    lead: tuple[str, ...] = ()
    either: tuple[str, ...] = ()
    attributes: list[str] = field(default_factory=list)

    @property
    def determined(self) -> bool:
        """Return whether a determiner precedes it."""
        return any(word in _determiners() for word in self.lead)

    @property
    def whole(self) -> bool:
        """Return whether it refers to all that there is."""
        return self.name in section("whole_words")

    def without_denial(self) -> Phrase:
        """Return it without "no" and the like."""
        name = pairs("affirmed").get(self.name, self.name)
        return replace(self, name=name, lead=tuple(w for w in self.lead if w not in section("none_words")))

    def said(self) -> NounPhrase:
        """Return it as the noun phrase of a clause."""
        words = (*self.lead, self.name) if self.pronoun or self.whole else self.lead
        if not (self.plural or self.pronoun or self.of):
            words = tuple(w for w in words if w not in section("both_words"))  # "both the cup and the mug": one of each
        quantity = self.quantity or next((w for w in self.lead if is_number(w) and number_of(w) != 1), "")
        both = not section("both_words").isdisjoint(words)
        return NounPhrase(
            name=self.name,
            quantifier=self._quantifier(words, quantity),
            number=number_of(quantity) if quantity else 2 if both else None,
            definite=self.determined and (section("indefinite") | section("none_words")).isdisjoint(self.lead),
            plural=self.plural,
            attributes=tuple(dict.fromkeys([*self._adjectives(), *self.attributes])),
            either=self.either,
            each=not section("each_words").isdisjoint(words),
            undetermined=self._undetermined(),
            other=not section("other_words").isdisjoint(self.lead),
        )

    def _undetermined(self) -> bool:
        return not (self.lead or self.plural or self.pronoun)

    def _adjectives(self) -> list[str]:
        """Return the adjectives before the head."""
        return [w for w in self.lead if w not in _determiners() | section("other_words") and not is_number(w)]

    def _quantifier(self, words: tuple[str, ...], quantity: str) -> Quantifier:
        several = self.plural or self.name in section("plural_pronouns")
        one_of = several and self.lead[:1] != () and number_of(self.lead[0]) == 1
        rows = (
            (Quantifier.NONE, not section("none_words").isdisjoint((*self.lead, self.name))),
            (Quantifier.ALL, self.whole or not section("all_words").isdisjoint(words)),
            (Quantifier.NUMBER, number_of(quantity) not in (None, 1)),
            (Quantifier.SOME, one_of or not section("some_words").isdisjoint(self.lead)),
        )
        return next((quantifier for quantifier, holds in rows if holds), Quantifier.PLAIN)

    def all(self) -> Iterator[Phrase]:
        """Yield the phrase and everything under it."""
        yield self
        for phrase in self.of:
            yield from phrase.all()


@cache
def _determiners() -> frozenset[str]:
    names = ("determiners", "quantifiers", "definite", "indefinite", "all_words", "none_words")
    return frozenset().union(*(section(name) for name in names))


def phrases_of(group: Tree[Leaf]) -> list[Phrase]:
    """Return the phrases of a group; "or" makes them alternatives."""
    phrases = [phrase_of(node) for node in trees(group.children, "phrase")]
    if any(isinstance(n, Leaf) and n.source.form == CHOICE for n in group.children):
        _choose(phrases)
    result: list[Phrase] = []
    for phrase in phrases:
        host = result[-1] if result else None
        if host is not None and host.of and host.name in section("inner_and") and not phrase.determined:
            host.of.append(phrase)
        else:
            result.append(phrase)
    return result


def _choose(phrases: list[Phrase]) -> None:
    """Make phrases alternatives; "neither" denies all of them."""
    none = [w for w in phrases[0].lead if w in section("none_words")]
    for phrase in phrases:
        if not none:
            phrase.either = tuple(p.name for p in phrases)
        elif phrase is not phrases[0]:
            phrase.lead = (*none, *phrase.lead)


def also_of(group: Tree[Leaf]) -> list[Phrase]:
    """Return the phrases of a group that go with what stands before it: "… and the lid too"."""
    joint = next((i for i, n in enumerate(group.children) if isinstance(n, Leaf) and n.source.form == ALSO), None)
    return [] if joint is None else [phrase_of(n) for n in trees(group.children[joint:], "phrase")]


def phrase_of(node: Tree[Leaf]) -> Phrase:
    """Return one phrase, with what hangs on it with "of"."""
    chain: list[Phrase] = []
    lead: list[Token] = []
    for child in node.children:
        if isinstance(child, Leaf):
            lead.append(child.source)
            continue
        phrase = _head(list(leaves(child)), [t for t in lead if t.kind is not Kind.OF])
        if chain:
            chain[-1].of.append(phrase)
        chain.append(phrase)
        lead = []
    return chain[0]


def _head(words: list[Token], lead: list[Token]) -> Phrase:
    """Return the phrase of a head; "the white one" and "the other" pick one of the things mentioned."""
    start, said = words[0].span.start, tuple(t.text for t in lead)
    texts, last = [t.text for t in words], words[-1]
    alone = _one_of(texts[0], start, said) if len(texts) == 1 else None
    if alone is not None:
        return alone
    written = "_".join(texts)
    quantity = next((t.text for t in reversed(lead) if t.kind is Kind.NUM), "")
    if last.text in section("one_words"):
        name = "_".join([*texts[:-1], singular(last.text)])
        return Phrase(name, start, name != written, True, quantity, lead=(*said, *texts[:-1]))
    pronoun = last.kind is Kind.PRON
    name = written if pronoun or last.form == NAME else singular(written)
    return Phrase(name, start, name != written, pronoun, quantity, lead=said)


def _one_of(word: str, start: int, lead: tuple[str, ...]) -> Phrase | None:
    """Return "the other", "the first", "the rest" or "that one"; ``None`` for any other word."""
    one = first_of("one_words")
    if word in section("other_words"):
        return Phrase(one, start, False, True, lead=(*lead, word))
    if word in section("ordinals"):
        return Phrase(f"{word}_{one}", start, False, True, lead=lead)
    if word in section("rest_words") and lead:
        return Phrase(one, start, True, True, lead=(*lead, first_of("other_words")))
    if word == one and lead and lead[-1] in section("demonstratives"):
        return Phrase(lead[-1], start, False, True, lead=lead[:-1])
    return None


def named_in(nodes: Sequence[Node]) -> list[Phrase]:
    """Return the phrases of the groups among some nodes."""
    return [phrase for group in trees(nodes, "group") for phrase in phrases_of(group)]


def about_things(nodes: Sequence[Node]) -> bool:
    """Return whether some of the nodes is a group that names more than a person."""
    names = (phrase.name for phrase in named_in(nodes))
    somebody = (PERSONS | section("subjects")) - section("all_people")
    return any(name not in somebody for name in names)
