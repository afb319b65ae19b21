"""Rebuild the WordNet subsets of ``tmd/language/data`` from WordNet 3.0's own ``dict`` files.

Run ``python -m experiments.language.rebuild [DICT] [OUT]``; DICT is ``/usr/share/wordnet`` on Debian (package
``wordnet-base``), OUT ``tmd/language/data``, where the licence of WordNet stands beside them. The output is the same
bytes for the same input. What is written:

* ``wordnet_verbs.txt``: single-word verbs, each with how much it is also a noun (``nv`` for all that do not
  occur in WordNet's tagged texts) and its irregular forms; and the tagged verbs with a particle.
* ``wordnet_words.txt.gz``: single words of any class: what counts as an English word.
* ``wordnet_nouns.txt.gz``: artifacts, food and substances with all their hypernyms.
"""

from __future__ import annotations

import gzip
import sys
from collections.abc import Iterator
from pathlib import Path

PARTICLES = frozenset(["away", "back", "down", "out", "up"])
NOUN_FILES = {6: "artifact", 13: "food", 27: "substance"}
"""Lexicographer files of WordNet whose synsets are kept."""


def index_lines(dict_dir: Path, part: str) -> Iterator[tuple[str, int, tuple[str, ...]]]:
    """Yield (lemma, number of tagged senses, synset offsets) of one ``index`` file."""
    for line in (dict_dir / f"index.{part}").read_text(encoding="ascii").splitlines():
        if line.startswith("  "):
            continue
        fields = line.split()
        offsets = fields[-int(fields[2]) :]
        yield fields[0], int(fields[-len(offsets) - 1]), tuple(offsets)


PASTS = frozenset({"fell"})
"""Verbs that are far more often the past of another one."""


def tag_counts(dict_dir: Path) -> dict[tuple[str, str], int]:
    """Return how often each (lemma, class) occurs in the tagged texts."""
    counts: dict[tuple[str, str], int] = {}
    classes = {"1": "n", "2": "v", "3": "a", "4": "r", "5": "a"}
    for line in (dict_dir / "cntlist.rev").read_text(encoding="ascii").splitlines():
        key, _, count = line.split()
        lemma, sense = key.split("%")
        pair = (lemma, classes[sense[0]])
        counts[pair] = counts.get(pair, 0) + int(count)
    return counts


def verb_lines(dict_dir: Path) -> list[str]:
    """Return the lines of ``wordnet_verbs.txt``."""
    counts = tag_counts(dict_dir)
    forms: dict[str, list[str]] = {}
    for line in (dict_dir / "verb.exc").read_text(encoding="ascii").splitlines():
        form, *stems = line.split()
        for stem in stems:
            forms.setdefault(stem, []).append(form)
    nouns = {lemma for lemma, _, _ in index_lines(dict_dir, "noun")}
    lines = []
    for lemma, tagged, _ in index_lines(dict_dir, "verb"):
        words = lemma.split("_")
        if tagged and len(words) == 2 and words[1] in PARTICLES and words[0].isalpha():
            lines.append(lemma)
        if not lemma.isalpha() or len(lemma) < 3 or lemma in PASTS:
            continue
        as_verb, as_noun = counts.get((lemma, "v"), 0), counts.get((lemma, "n"), 0)
        flag = "v" if lemma not in nouns else "vn" if as_verb > as_noun else "nv"
        if not tagged:
            flag = "nv"
        lines.append(" ".join([lemma, flag, *sorted(forms.get(lemma, ()))]))
    return sorted(lines)


def word_lines(dict_dir: Path) -> list[str]:
    """Return the lines of ``wordnet_words.txt.gz``: tagged words of any class, and all things."""
    words = set()
    for part in ("noun", "verb", "adj", "adv"):
        words |= {w for w, tagged, _ in index_lines(dict_dir, part) if tagged and w.isalpha() and len(w) > 1}
    things = {lemma for line in noun_lines(dict_dir) for lemma in line.partition("\t")[2].split()}
    words |= {lemma.rpartition(".")[0] for lemma in things}
    return sorted(w for w in words if w.isalpha())


def noun_lines(dict_dir: Path) -> list[str]:
    """Return the lines of ``wordnet_nouns.txt.gz``: ``parents<TAB>lemma.sense ...``, parents first."""
    lexfile: dict[str, int] = {}
    parents: dict[str, list[str]] = {}
    for line in (dict_dir / "data.noun").read_text(encoding="ascii").splitlines():
        if line.startswith("  "):
            continue
        fields = line.split(" | ")[0].split()
        pointers = fields[4 + 2 * int(fields[3], 16) + 1 :]
        lexfile[fields[0]] = int(fields[1])
        parents[fields[0]] = [pointers[i + 1] for i in range(0, len(pointers) - 3, 4) if pointers[i] in ("@", "@i")]
    kept = {offset for offset, number in lexfile.items() if number in NOUN_FILES}
    order: dict[str, int] = {}

    def place(offset: str) -> None:
        if offset not in order:
            for parent in parents[offset]:
                place(parent)
            order[offset] = len(order)

    for offset in sorted(kept):
        place(offset)
    lemmas: dict[str, list[str]] = {offset: [] for offset in order}
    for lemma, _, offsets in index_lines(dict_dir, "noun"):
        for sense, offset in enumerate(offsets, 1):
            if offset in kept:
                lemmas[offset].append(f"{lemma}.{sense}")
    return [f"{','.join(str(order[p]) for p in parents[offset])}\t{' '.join(lemmas[offset])}" for offset in order]


def write_gz(path: Path, lines: list[str]) -> None:
    """Write lines as gzip without a time stamp."""
    path.write_bytes(gzip.compress(("\n".join(lines) + "\n").encode(), compresslevel=9, mtime=0))


def rebuild(dict_dir: Path, out: Path) -> None:
    """Write the three files into ``out``."""
    verbs = ["# WordNet 3.0, see LICENSE-WORDNET; written by rebuild.py", *verb_lines(dict_dir)]
    (out / "wordnet_verbs.txt").write_text("\n".join(verbs) + "\n", encoding="utf-8")
    write_gz(out / "wordnet_words.txt.gz", word_lines(dict_dir))
    write_gz(out / "wordnet_nouns.txt.gz", noun_lines(dict_dir))


if __name__ == "__main__":
    data = Path(__file__).resolve().parents[2] / "tmd" / "language" / "data"
    arguments = [Path(a) for a in sys.argv[1:]]
    rebuild(arguments[0] if arguments else Path("/usr/share/wordnet"), arguments[1] if arguments[1:] else data)
