"""First tags: closed classes, phrases of several words, durations and measures, typos, verb readings."""

from __future__ import annotations

from itertools import pairwise

from tmd.language.clause import Span
from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.lexicon.words import comparative_root, phrases, positive, section, singular, slips
from tmd.language.syntax.tokens import NAME, Kind, Token

_PHRASES = (
    ("multiword_prepositions", Kind.P, ""),
    ("multiword_adverbs", Kind.ADV, ""),
    ("purposes", Kind.PURP, ""),
    ("conditions", Kind.SUB, ""),
    ("ensure", Kind.ENSURE, ""),
)
_SPELLING = {"in_to": "into", "on_to": "onto"}
_CLOSED = (
    ("be", Kind.AUX),
    ("modals", Kind.AUX),
    ("negations", Kind.NEG),
    ("determiners", Kind.DET),
    ("pronouns", Kind.PRON),
    ("conditions", Kind.SUB),
    ("ensure", Kind.ENSURE),
    ("let_verbs", Kind.LET),
)
_FRACTIONS = ("half", "quarter", "quarters", "third", "thirds")
_TITLES = frozenset({"mr", "mrs", "ms", "miss", "dr", "doctor", "nurse", "professor", "sister", "captain"})
_CONTRACTED = ("'ll", "'d", "'ve")


def fold(tokens: list[Token], kind: Kind, joint: str = "_", form: str = "") -> Token:
    """Make one token of a run."""
    span = Span(min(t.span.start for t in tokens), max(t.span.end for t in tokens))
    return Token(kind, joint.join(t.text for t in tokens), span, form=form, inner=tokens)


def tag(tokens: list[Token], lexicon: Lexicon) -> list[Token]:
    """Give every token its first tag."""
    tagged: list[Token] = []
    position = 0
    while position < len(tokens):
        merged, used = _phrase(tokens, position)
        if merged is None:
            merged, used = _measure(tokens, position)
        if merged is None:
            merged, used = _time(tokens, position)
        if merged is None:
            merged, used = tokens[position], 1
            if merged.kind is Kind.WORD:
                _tag_word(merged, lexicon)
            starts = not tagged or tagged[-1].kind in (Kind.STOP, Kind.CC)
            if merged.kind is Kind.SUB and merged.text in lexicon.verbs and starts:
                # "Till the bed": the domain has such a verb
                merged.kind, merged.stem, merged.form, merged.strength = Kind.WORD, merged.text, "base", 2
        tagged.append(merged)
        position += used
    _compounds(tagged)
    _misspelt_from(tagged)
    return tagged


def _compounds(tokens: list[Token]) -> None:
    """Keep the first word of "light bulb", which is dropped elsewhere, and of names ("Canada Dry")."""
    for before, first, second in zip(tokens, tokens[1:], tokens[2:], strict=False):
        if before.kind is Kind.DET and first.text in ("third", "quarter") and second.kind is Kind.WORD:
            first.kind, first.stem, first.strength = Kind.N, "", 0  # "the third burner" is no fraction
    for first, second in pairwise(tokens):
        if first.text in _TITLES and second.capital:
            for word in (first, second):
                word.kind, word.stem, word.strength = Kind.N, "", 0
        elif f"{first.text}_{singular(second.text)}" in section("compounds"):
            first.kind, first.stem, first.strength = Kind.N, "", 0
        elif second.kind is Kind.ADJ and first.capital and second.capital:
            second.kind = Kind.N


def _misspelt_from(tokens: list[Token]) -> None:
    """Read "get the bowl form the shelf" as "from"."""
    for before, token, after in zip(tokens, tokens[1:], tokens[2:], strict=False):
        if token.text == "form" and before.kind in (Kind.WORD, Kind.PRON, Kind.N) and after.kind is Kind.DET:
            token.kind, token.text, token.stem, token.strength = Kind.P, "from", "", 0


def _phrase(tokens: list[Token], at: int) -> tuple[Token | None, int]:
    best: tuple[Token | None, int] = (None, 0)
    for name, kind, form in _PHRASES:
        for words in phrases(name).get(tokens[at].text, ()):
            run = tokens[at : at + len(words)]
            measured = kind is Kind.ADV and tokens[at + len(words) :][:1] and tokens[at + len(words)].text == "of"
            if measured:
                continue
            if len(words) > max(1, best[1]) and tuple(t.text for t in run) == words:
                token = fold(run, kind, form=form)
                token.text = _SPELLING.get(token.text, token.text)
                best = token, len(words)
    return best


def _time(tokens: list[Token], at: int) -> tuple[Token | None, int]:
    """Fold "at 6 pm", "in the morning", "for the given time": when, and no thing."""
    if tokens[at].text not in section("before_time"):
        return None, 0
    words = [t.text for t in tokens[at : at + 6]]
    end = 1
    while end < len(words) and words[end] in section("determiners") | section("drop_adjectives"):
        end += 1
    clock = words[2:3] in (["am"], ["pm"], ["o'clock"])
    if end == 1 and len(words) > 1 and words[1][0].isdigit() and (clock or words[0] in ("at", "by")):
        end += 1 + clock
    elif end < len(words) and words[end] in section("time_nouns"):
        end += 1
    else:
        return None, 0
    if words[end : end + 1] and tokens[at + end].kind is Kind.WORD and words[end] in section("nouns") | {"of"}:
        return None, 0
    return fold(tokens[at : at + end], Kind.MOD, " ", "setting"), end


def _measure(tokens: list[Token], at: int) -> tuple[Token | None, int]:
    """Fold "for about 3 minutes", "to 180 degrees", "two feet"; the numeral words are still undecided."""
    end, words = at, [t.text for t in tokens[at : at + 8]]
    for text in words:
        if text in section("before_measure"):
            end += 1
        else:
            break
    lead = end - at
    number = 0
    while lead + number < len(words) and _is_number(words[lead + number]):
        number += 1
    unit = lead + number
    if number and words[unit - 1] == "half" and words[unit : unit + 1] in (["a"], ["an"]):
        unit += 1
    if unit >= len(words):
        return None, 0
    article = number == 0 and lead < len(words) and words[lead] in ("a", "an")
    if article:
        unit += 1
    parted = number and ("/" in words[unit - 1] or words[unit - 1] in _FRACTIONS)
    if parted and words[unit : unit + 1] == ["full"]:
        return fold(tokens[at : at + unit + 1], Kind.MOD, " ", "setting"), unit + 1
    rest = words[unit : unit + 2]
    of_next = len(rest) > 1 and rest[1] == "of"
    if number and words[unit : unit + 3] == ["of", "the", "way"]:
        return fold(tokens[at : at + unit + 3], Kind.MOD, " ", "setting"), unit + 3
    if not rest or not (number or article) or of_next:
        return None, 0
    if rest[0] in ("more", "full") and rest[1:]:
        unit, rest = unit + 1, rest[1:]
    form = "duration" if rest[0] in section("units_time") else "setting"
    if form == "duration" and article and not lead and rest[0] in ("bit", "times", "time"):
        return None, 0
    if form == "setting" and (article or not _is_unit(rest[0], words[unit:])):
        return None, 0
    used = unit + 1
    if form == "setting":
        while used < len(words) and words[used] in (
            "celsius",
            "celcius",
            "fahrenheit",
            "c",
            "f",
            "full",
            "the",
            "way",
        ):
            used += 1
    return fold(tokens[at : at + used], Kind.MOD, " ", form), used


def _is_number(word: str) -> bool:
    return (word[0].isdigit() and not word.endswith(("st", "nd", "rd", "th"))) or word in section("numbers")


def _is_unit(word: str, words: list[str]) -> bool:
    if word == "of" or word in ("step", "steps"):
        return False
    return word in section("units") or word in ("quarters", "thirds")


def _tag_word(token: Token, lexicon: Lexicon) -> None:
    word = token.text
    if word.endswith("'s") and word not in section("be") and word != "let's":
        word = token.text = word[:-2]
        token.form = "possessive"
    word = token.text = slips().get(word, word).rstrip("'")
    if word.endswith(_CONTRACTED):
        token.kind = Kind.SUBJECT
        return
    corrected = lexicon.correct(word) if word.isalpha() and not token.capital else None
    word = token.text = (corrected or word).replace("-", "_")
    token.kind = _closed(word)
    if token.kind is Kind.WORD and word.endswith("ly") and len(word) > 5 and not lexicon.is_noun(word):
        token.kind = Kind.ADV
    if token.capital and token.kind is Kind.WORD and not lexicon.knows(singular(word)):
        token.form = NAME
    if token.kind in (Kind.WORD, Kind.ADJ):
        reading = lexicon.verb(word)
        if reading is None and "_" in word:
            # "deep-fry", "hard-boil": what stands before the hyphen says how
            last = lexicon.verb(word.rpartition("_")[2])
            reading = last if last is not None and last[1:] == ("base", 3) else None
        if reading:
            token.stem, token.form, token.strength = reading[0], token.form or reading[1], reading[2]
    elif token.kind is Kind.LET:
        token.stem, token.form, token.strength = word, "base", 3


def _closed(word: str) -> Kind:
    if word in ("and", "or", "plus", "but", "then"):
        return Kind.CC
    if word == "to":
        return Kind.TO
    if _is_number(word):
        return Kind.NUM
    if word in section("quantifiers"):
        return Kind.DET
    for name, kind in _CLOSED:
        if word in section(name):
            return kind
    if word in section("relatives"):
        return Kind.REL
    if word in section("drop_adjectives") and word not in section("verbs") | section("noun_verbs"):
        return Kind.ADJ
    if positive(word) != word and {positive(word), positive(word) + "e"} & section("drop_adjectives"):
        return Kind.ADJ
    if any(root in section("drop_adjectives") for root in comparative_root(word)) and word not in section("nouns"):
        return Kind.ADJ
    if word in section("prepositions"):
        return Kind.P
    if word in section("adverbs") and word not in section("verbs"):
        return Kind.ADV
    return Kind.WORD
