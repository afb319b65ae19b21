"""The names in a domain and all that belongs to it: where they are declared and used, and how they are renamed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Set
from contextlib import suppress
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from tmd.check.checker import DATA_FILES, is_ours
from tmd.diagnostics import TmdError
from tmd.editor.names import NameKind, Occurrence, Role, names_in_pddl
from tmd.editor.yaml_names import names_in_yaml
from tmd.files import real
from tmd.pddl.model import OBJECT, TOTAL_COST
from tmd.pddl.reading.formulas import RESERVED
from tmd.pddl.reading.syntax import Source, after, read_text, split_lines
from tmd.world.folder import find_domain, find_problems
from tmd.world.problem_domain import domain_named_in, find_domain_file, folder_near, kind_and_name
from tmd.world.roots import Roots

YAML = (".yaml", ".yml")
_NAME = re.compile(r"[a-z][a-z0-9_-]*")
_DOMAIN = re.compile(r"^domain:[ \t]*['\"]?([\w-]+)", re.MULTILINE)
_ENVIRONMENT = re.compile(r"^objects:", re.MULTILINE)
_BUILT_IN = RESERVED | {OBJECT, TOTAL_COST}
# A folder with more files of a kind than that is no domain.
_MOST_FILES = 500
# Files that are read for hovering: a benchmark may have hundreds of large problems.
_MOST_READ = 30


lines_of = lru_cache(maxsize=_MOST_FILES)(split_lines)
"""The lines of a text; many places of one text are asked for."""


@lru_cache(maxsize=_MOST_FILES)
def _names(text: str, file: str) -> tuple[Occurrence, ...]:
    return tuple((names_in_yaml if Path(file).suffix in YAML else names_in_pddl)(text, file))


@dataclass(slots=True)
class Project:
    """The files that are open, and those on the disk that belong to them."""

    roots: Roots = field(default_factory=Roots)
    files: dict[Path, None] = field(default_factory=dict)

    def text(self, file: Path) -> str:
        """Return the text of a file; empty where it cannot be read."""
        try:
            return read_text(file)
        except TmdError:
            return ""

    def is_ours(self, file: Path, text: str) -> bool:
        """Return whether a file is of a domain: PDDL, YAML of a known name, or an environment."""
        return is_ours(file) or (file.suffix in YAML and bool(_DOMAIN.search(text) and _ENVIRONMENT.search(text)))

    def names(self, file: Path) -> tuple[Occurrence, ...]:
        """Return the names in a file."""
        return _names(self.text(file), str(file))

    def at(self, file: Path, line: int, column: int) -> list[Occurrence]:
        """Return the names that stand or end at a place; several where a word may be of several kinds."""
        names = (name for name in self.names(file) if name.place.line == line)
        return [name for name in names if 0 <= column - name.place.column <= len(name.name)]

    def domain_of(self, file: Path) -> Path | None:
        """Return the file of the domain that a file belongs to."""
        text = self.text(file)
        if file.suffix in YAML and file.name not in DATA_FILES:
            name = next(iter(_DOMAIN.findall(text)), "")
            with suppress(TmdError):
                return real((folder_near(file, name) or find_domain(name, self.roots.domains).path) / "domain.pddl")
            return None
        if file.suffix != ".pddl" or file.name == "instructions.pddl":
            sources = (file.parent / "domain.pddl", file.parent / "instructions.pddl")
            return real(sources[0]) if any(path.is_file() or path in self.files for path in sources) else None
        if kind_and_name(text)[0] == "domain":
            return file
        found = find_domain_file(file, domain_named_in(text), self.roots.domains).file
        return real(found) if found else None

    def environments(self, domain: Path) -> list[Path]:
        """Return the environments and problems of a domain: those that are open, bundled, or near it."""
        folder = domain.parent
        beside = folder.parent.parent / "problems" / folder.name
        with suppress(TmdError):
            beside = beside if beside.is_dir() else find_problems(folder.name, self.roots.problems)
        patterns = ((beside / "environments", "*"), (beside, "*.pddl"), (folder, "*.pddl"), (folder, "*/*.pddl"))
        found = dict.fromkeys(self.files)
        for directory, pattern in patterns:
            found |= dict.fromkeys(real(path) for path in sorted(directory.glob(pattern))[:_MOST_FILES])
        return [file for file in found if self._is_environment(file) and self.domain_of(file) == domain]

    def _is_environment(self, file: Path) -> bool:
        if file.suffix in YAML:
            return file.name not in DATA_FILES
        return file.suffix == ".pddl" and kind_and_name(self.text(file))[0] == "problem"

    def own(self, file: Path) -> list[Path]:
        """Return the files whose declarations hold in a file, itself first."""
        domain = self.domain_of(file)
        if domain is None:
            return [file]
        names = ("instructions.pddl", "lexicon.yaml", "objects.yaml", "skills.yaml")
        beside = [domain.parent / name for name in names] if domain.name == "domain.pddl" else []
        return [path for path in dict.fromkeys((file, domain, *beside)) if path.is_file() or path in self.files]

    def related(self, file: Path) -> list[Path]:
        """Return the files in which the names of a file may stand, itself first."""
        domain = self.domain_of(file)
        return list(dict.fromkeys((*self.own(file), *(self.environments(domain) if domain else ()))))

    def declarations(self, file: Path, *kinds: NameKind) -> list[Occurrence]:
        """Return what a file may name: objects of other problems are not among it."""
        names = (name for path in self.own(file) for name in self.names(path) if name.kind in kinds)
        return [name for name in names if name.role is Role.DECLARED]

    def definitions(self, file: Path, name: Occurrence) -> list[Occurrence]:
        """Return where a name is declared."""
        if name.kind is NameKind.VARIABLE:
            return [other for other in self._same(file, name) if other.role is Role.DECLARED]
        return [other for other in self.declarations(file, name.kind) if other.name == name.name]

    def references(self, file: Path, name: Occurrence, most: int | None = None) -> list[Occurrence]:
        """Return every place of a name, its declarations included; ``most`` is the number of files that are read."""
        if name.kind is NameKind.VARIABLE or self._local(file, name):
            return self._same(file, name)
        same = (other for path in self.related(file)[:most] for other in self._same(path, name))
        return [other for other in same if not self._local(Path(other.place.file), other)]

    def _same(self, file: Path, name: Occurrence) -> list[Occurrence]:
        key = name.kind, name.name, name.scope
        return [other for other in self.names(file) if (other.kind, other.name, other.scope) == key]

    def _local(self, file: Path, name: Occurrence) -> bool:
        """Return whether a name is an object of one problem or environment."""
        if name.kind is not NameKind.OBJECT or not self._is_environment(file):
            return False
        return any(other.role is Role.DECLARED for other in self._same(file, name))

    def rename(self, file: Path, name: Occurrence, new: str) -> list[Occurrence]:
        """Return the places in which ``new`` is to be written.

        Raises:
            TmdError: The name is not declared, or ``new`` is not a name or is taken.
        """
        if not self.definitions(file, name) or name.name in _BUILT_IN:
            raise TmdError(f"'{name.name}' is not declared in this domain, or is a word of PDDL")
        places = self.references(file, name)
        _check_name(new, {Path(place.place.file).suffix for place in places})
        taken = self._taken(file, name, new)
        if taken is not None:
            raise TmdError(f"there is a {name.kind} '{taken.name}' already: {taken.place}")
        misread = [place for place in places if not self._stands_at(place)]
        if misread:
            raise TmdError(f"{misread[0].place}: '{name.name}' is not found there, so nothing was renamed")
        return places

    def _stands_at(self, name: Occurrence) -> bool:
        """Return whether a name is found at its place; YAML knows ends of lines that editors do not count."""
        place, lines = name.place, lines_of(self.text(Path(name.place.file)))
        line = lines[place.line - 1] if place.line <= len(lines) else ""
        return line[place.column - 1 :].lower().startswith(name.name)

    def _taken(self, file: Path, name: Occurrence, new: str) -> Occurrence | None:
        """Return what has the name ``new`` where ``name`` is known."""
        if name.kind is NameKind.VARIABLE:
            others = [other for other in self.names(file) if other.within == name.within]
        else:
            others = [other for path in self.related(file) for other in self.names(path) if other.role is Role.DECLARED]
        return next((other for other in others if (other.kind, other.name) == (name.kind, new)), None)

    def unchanged(self, file: Path, name: Occurrence) -> list[Path]:
        """Return the other files of a domain in which a name stands as a word, and in which it is not renamed."""
        domain = self.domain_of(file)
        if domain is None or name.kind is NameKind.VARIABLE or domain.name != "domain.pddl":
            return []
        places = {environment.parent.parent for environment in self.environments(domain)} - {domain.parent}
        found = [domain.parent / "templates.yaml"]
        found += [path for place in sorted(places) for path in sorted(place.glob("**/*.jsonl"))[:_MOST_FILES]]
        word = re.compile(rf"(?<![\w-]){re.escape(name.name)}(?![\w-])")
        return [path for path in found if path.is_file() and word.search(self.text(path))]

    def hover(self, file: Path, name: Occurrence) -> str:
        """Return what is known of a declared name, as Markdown."""
        declared = self.definitions(file, name)[0]
        lines = [f"**{name.kind}** `{name.name}`" + (f" - `{' | '.join(declared.types)}`" if declared.types else "")]
        lines += [f"```pddl\n{self._source(declared)}\n```"] if declared.group else []
        if name.kind is NameKind.TYPE:
            for title, kind in (("subtypes", NameKind.TYPE), ("objects", NameKind.OBJECT)):
                lines += _listed(title, (n.name for n in self.declarations(file, kind) if name.name in n.types))
        if name.kind in (NameKind.PREDICATE, NameKind.FUNCTION):
            lines += _by_role(self.references(file, name, _MOST_READ))
        return "\n\n".join(lines)

    def _source(self, declared: Occurrence) -> str:
        """Return the text of a declaration, with the comment behind it."""
        assert declared.group is not None
        begin, end = declared.group.location, declared.group.end
        lines = lines_of(self.text(Path(begin.file)))
        if declared.kind is NameKind.ACTION:
            return "\n".join(lines[begin.line - 1 : end.line])
        _, mark, comment = lines[end.line - 1][end.column :].partition(";")
        return Source(begin.file, lines).text(begin, after(declared.group)) + (f"  ;{comment}" if mark else "")


def _check_name(name: str, suffixes: Set[str]) -> None:
    """Refuse what files with these suffixes do not take for a name, and the names that PDDL has a meaning for."""
    if not _NAME.fullmatch(name.removeprefix("?")) or name in _BUILT_IN:
        raise TmdError(f"'{name}' is not a name: a small letter first, then letters, digits, - and _")
    if "-" in name and not suffixes.isdisjoint(YAML):
        raise TmdError(f"'{name}' is not a name for YAML files: letters, digits and _")


_TITLES: Mapping[Role, str] = {
    Role.READ: "read by",
    Role.ADDED: "made true by",
    Role.DELETED: "made false by",
    Role.HOLDS: "holds at the start in",
}
_MOST_LISTED = 20


def _by_role(used: Iterable[Occurrence]) -> Iterator[str]:
    """Yield who reads and who writes a predicate, a line for each role."""
    found: dict[Role, dict[str, None]] = {}
    for one in used:
        file = Path(one.place.file)
        where = one.within if one.within.startswith(("action", "derived")) else file.name
        found.setdefault(one.role, {})[where] = None
    for role, title in _TITLES.items():
        yield from _listed(title, found.get(role, ()))


def _listed(title: str, names: Iterable[str]) -> list[str]:
    listed = list(dict.fromkeys(names))
    more = f", and {len(listed) - _MOST_LISTED} more" if len(listed) > _MOST_LISTED else ""
    return [f"{title}: {', '.join(listed[:_MOST_LISTED])}{more}"] if listed else []
