"""Object graphs to PDDL: classes and instructions to ``domain.pddl``, an environment to a problem.

A class becomes a type, a part an object ``<object>_<part>``, an edge of the graph a static fact that the action
schemas quantify over, a state an atom. The compiled domain stays one readable text: the hand-written
``instructions.pddl`` with the types and constants of ``objects.yaml`` set in.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from tmd.diagnostics import TmdError
from tmd.files import write_text
from tmd.pddl.model import (
    TRUE,
    ActionSchema,
    GroundAtom,
    Instruction,
    Predicate,
    Problem,
    State,
    TypedName,
    universe,
)
from tmd.pddl.reading.formulas import read_effects
from tmd.pddl.reading.reader import parse_domain
from tmd.pddl.reading.syntax import nearest, parse, read_text
from tmd.pddl.semantics import apply
from tmd.world.classes import ROOT, SELF, ObjectClass, StateValue, Vertex
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder
from tmd.world.yaml_positions import YamlSource

# Compiled for every part where the domain declares it: ``(part_of part object)``.
PART_OF = "part_of"
# ``at: on counter1`` compiles to ``(at object counter1 on)``.
AT = "at"
_HEADER = "; Compiled from instructions.pddl and objects.yaml; change those and run `tmd compile`.\n;\n"
_DERIVE = "derive"
_RULE = "a rule is an effect, such as (when (on ?x table1) (near ?x))"


def update_domain(folder: DomainFolder, *, write: bool = True) -> bool:
    """Compile a folder with object graphs to its ``domain.pddl``.

    The file is only compared with its sources without ``write``.

    Returns:
        Whether the file was not there, or was another.

    Raises:
        TmdError: A source is wrong, with its place; or the file cannot be read or written.
    """
    target, compiled = folder.path / "domain.pddl", compile_domain(folder)
    if target.is_file() and read_text(target) == compiled:
        return False
    if write:
        write_text(target, compiled)
    return True


def compile_domain(folder: DomainFolder) -> str:
    """Return the text of ``domain.pddl`` for a folder with object graphs.

    Raises:
        TmdError: A source is wrong; with its place.
    """
    path = folder.instructions_path
    text = read_text(path).replace("\r\n", "\n")
    document = parse(text, str(path))
    classes = folder.classes
    types = [f"{name} - {parent}" for name, parent in classes.new_types()]
    constants = [f"{name} - {kind}" for name, kind in classes.entries.substances.items()]
    lines = text.split("\n")
    insertions = []
    for section, added in ((":types", types), (":constants", constants)):
        group = document.source.sections.get(section)
        if group is None:
            raise TmdError(f"{path}: has no ({section} …) for objects.yaml to add to", hint=f"write ({section})")
        insertions.append((group.end, added, section))
    for end, added, section in sorted(insertions, key=lambda item: item[0], reverse=True):
        row, column = end.line - 1, end.column - 1
        before, after = lines[row][:column].rstrip(), lines[row][column:]
        block = [f"    ; {section[1:]} of objects.yaml", *(f"    {entry}" for entry in added), f"  {after}"]
        lines[row : row + 1] = ([before] if before else []) + block
    compiled = _HEADER + "\n".join(lines)
    parse_domain(compiled, str(folder.path / "domain.pddl"))
    return compiled


def compile_problem(environment: Environment, folder: DomainFolder) -> Problem:
    """Return the environment as a PDDL problem with an empty goal.

    Raises:
        TmdError: The environment does not fit the domain; with the place in its file.
    """
    return _Compiler(environment, folder).problem()


class _Compiler:
    """The compilation of one environment."""

    def __init__(self, environment: Environment, folder: DomainFolder) -> None:
        self.environment = environment
        self.source = environment.source
        self.folder = folder
        self.domain = folder.domain
        self.predicates = {p.name: p for p in self.domain.predicates}
        self.init: set[GroundAtom] = set()
        self.unclear: set[str] = set()
        if environment.domain != folder.name:
            message = f"this environment is of domain '{environment.domain}', not '{folder.name}'"
            self._fault(("domain",), message, None, "domain-mismatch")

    def problem(self) -> Problem:
        objects = tuple(self._objects())
        shell = Problem(self.environment.name, self.domain, objects)
        self.universe = universe(shell)
        for name, entry in self.environment.objects.items():
            if entry.class_name in self.folder.classes.entries.classes:
                self.source.recover(None, self._object, name, self.folder.classes.get(entry.class_name))
            self.source.recover(None, self._where, name, entry.at)
        self._stated()
        init = frozenset(self.init)
        return replace(shell, init=derive(replace(shell, init=init), self.folder, init))

    def _fault(self, path: Sequence[str], message: str, hint: str | None, code: str) -> None:
        self.source.fault(self.source.error(path, message, hint, code))

    def _objects(self) -> Iterable[TypedName]:
        constants = {c.name for c in self.domain.constants}
        classes = self.folder.classes.entries.classes
        names: set[str] = set()
        for name, entry in self.environment.objects.items():
            if entry.class_name not in classes:
                message = f"'{name}' is of class '{entry.class_name}', which objects.yaml does not have"
                hint = nearest(entry.class_name, sorted(classes))
                self._fault(("objects", name, "class"), message, hint, "unknown-class")
                self.unclear.add(name)
                continue
            for vertex in self.folder.classes.get(entry.class_name).vertices.values():
                full = _vertex(name, vertex.name)
                if full in names or full in constants:
                    message = f"there are two objects named '{full}'"
                    self._fault(("objects", name), message, "rename one of them", "duplicate-name")
                names.add(full)
                yield TypedName(full, (vertex.class_name,))

    def _object(self, name: str, graph: ObjectClass) -> None:
        entry = self.environment.objects[name]
        for part in entry.parts:
            if part not in graph.vertices or part == ROOT:
                hint = nearest(part, [p for p in graph.vertices if p != ROOT])
                message = f"'{name}' ({graph.name}) has no part '{part}'"
                self._fault(("objects", name, "parts", part), message, hint, "unknown-part")
        for vertex in graph.vertices.values():
            self._part(name, vertex)
        for edge in graph.edges:
            self._add(self._bind(edge, name, ROOT), ("objects", name))

    def _part(self, name: str, vertex: Vertex) -> None:
        """Add the facts and states of one vertex of an object."""
        entry, is_root = self.environment.objects[name], vertex.name == ROOT
        said = entry.states if is_root else entry.parts.get(vertex.name, {})
        place = ("objects", name, "states") if is_root else ("objects", name, "parts", vertex.name)
        for fact in (*vertex.facts, *vertex.init):
            self._add(self._bind(fact, name, vertex.name), ("objects", name))
        known = {*vertex.states, *self.predicates}
        for state in said:
            if state not in known:
                hint = nearest(state, sorted(known))
                self._fault((*place, state), f"'{name}' has no state '{state}'", hint, "unknown-state")
        for state, value in {**vertex.states, **said}.items():
            if state in known:
                self._set(_vertex(name, vertex.name), state, value, (*place, state))
        if not is_root and PART_OF in self.predicates:
            self._add((PART_OF, _vertex(name, vertex.name), name), ("objects", name))

    def _bind(self, fact: Sequence[str], name: str, vertex: str) -> tuple[str, ...]:
        """Return a fact of a class with its names replaced: ``self``, ``root`` and the object's parts."""
        parts = self.folder.classes.get(self.environment.objects[name].class_name).vertices
        own = (vertex if term == SELF else term for term in fact[1:])
        return fact[0], *(_vertex(name, term) if term in parts else term for term in own)

    def _set(self, vertex: str, state: str, value: StateValue, path: Sequence[str]) -> None:
        if value is False:
            return
        values = [()] if value is True else [(v,) for v in ([value] if isinstance(value, str) else value)]
        for rest in values:
            self._add((state, vertex, *rest), path)

    def _where(self, name: str, at: str | None) -> None:
        if at is None:
            return
        path = ("objects", name, "at")
        words = at.split()
        if len(words) != 2:
            raise self.source.error(path, f"'{at}' is no place", "write `RELATION OBJECT`")
        self._add((AT, name, words[1], words[0]), path)

    def _stated(self) -> None:
        said = self.folder.classes.entries
        for kind in ("facts", "init"):
            for number, fact in enumerate(getattr(said, kind)):
                self._add(tuple(fact.strip("()").split()), (kind, number), self.folder.classes.source)
        for index, fact in enumerate(self.environment.facts):
            self._add(tuple(fact.strip("()").split()), ("facts", index))

    def _add(self, words: Sequence[str], path: Sequence[str | int], source: YamlSource | None = None) -> None:
        """Add one atom after checking it; ``path`` leads to it in ``source``, by default the environment's file."""
        self.source.recover(None, self._add_checked, words, path, source or self.source)

    def _add_checked(self, words: Sequence[str], path: Sequence[str | int], source: YamlSource) -> None:
        """Add one atom after checking predicate, arity, names and types."""
        text, predicate = f"({' '.join(words)})", predicate_of(words, self.predicates, path, source)
        for parameter, name in zip(predicate.parameters, words[1:], strict=True):
            if name in self.unclear:
                return
            if name not in self.universe.types_of:
                hint = nearest(name, sorted(self.universe.types_of))
                raise source.error(path, f"{text}: there is no '{name}'", hint, "unknown-object")
            if not self.universe.is_a(name, parameter.types):
                is_a = "/".join(self.universe.types_of[name])
                message = f"{text}: '{name}' is a {is_a}, not a {'/'.join(parameter.types)}"
                raise source.error(path, message, None, "wrong-type")
        self.init.add(GroundAtom(words[0], tuple(words[1:])))


def predicate_of(
    words: Sequence[str], predicates: Mapping[str, Predicate], path: Sequence[str | int], source: YamlSource
) -> Predicate:
    """Return the predicate of a fact.

    Raises:
        TmdError: There is no such predicate, or it takes another number of arguments.
    """
    text, name = " ".join(words), words[0] if words else ""
    if name not in predicates:
        hint = nearest(name, sorted(predicates))
        raise source.error(path, f"({text}): the domain has no predicate '{name}'", hint, "unknown-predicate")
    wanted = len(predicates[name].parameters)
    if wanted != len(words) - 1:
        message = f"({text}): '{name}' takes {wanted} argument(s), found {len(words) - 1}"
        raise source.error(path, message, None, "wrong-arity")
    return predicates[name]


def derive(problem: Problem, folder: DomainFolder, state: State) -> State:
    """Return ``state`` with the ``derive`` rules of ``objects.yaml`` applied, in their order.

    Raises:
        TmdError: A rule is wrong; with its place.
    """
    for schema in derive_rules(folder):
        domain = replace(problem.domain, actions=(schema,))
        state = apply(Instruction(_DERIVE), state, replace(problem, domain=domain))
    return state


def derive_rules(folder: DomainFolder) -> Iterable[ActionSchema]:
    """Return the ``derive`` rules of ``objects.yaml`` as actions without parameters.

    Raises:
        TmdError: A rule is wrong; with its place.
    """
    source = folder.classes.source
    for index, rule in enumerate(folder.classes.entries.derive):
        document = parse(rule, str(source.path))
        try:
            effects = tuple(read_effects(document.groups[0], document.source).flat)
        except TmdError as error:
            message, hint = f"derive: {rule}: {error.message}", error.hint or _RULE
            raise TmdError(message, location=source.locate(("derive", index)), hint=hint) from error
        except IndexError:
            raise source.error(("derive", index), "derive: the rule is empty", _RULE, "") from None
        yield ActionSchema(_DERIVE, (), TRUE, effects)


def _vertex(name: str, part: str) -> str:
    return name if part == ROOT else f"{name}_{part}"
