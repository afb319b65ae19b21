"""A package imports only packages of lower layers, no two modules import one another, and folders stay small."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest
from radon.complexity import cc_visit

PACKAGE = Path(__file__).parents[1] / "tmd"
LAYERS = (
    ("short_repr",),
    ("diagnostics",),
    ("files", "yaml_nodes", "json_record"),
    ("pddl", "language"),
    ("world", "planning", "format"),
    ("library", "datasets", "robot"),
    ("goals",),
    ("readers",),
    ("inference",),
    ("knowledge", "grounded"),
    ("records",),
    ("ground", "export"),
    ("view",),
    ("evaluation",),
    ("check", "robot_trials", "studio"),
    ("domain_kit", "editor"),
    ("api",),
    ("cli",),
)
"""From the lowest to the highest; nothing imports from its own layer but its own package."""
LAYER = {package: number for number, layer in enumerate(LAYERS) for package in layer}
HEAVY = {
    "unified_planning", "up_fast_downward", "numba", "pandas", "pybullet", "rich", "joblib",
    "matplotlib", "jinja2", "scipy", "distributed", "dask", "imageio", "PIL",
    "viser", "trimesh", "vhacdx", "mcap_ros2", "mujoco", "openai", "pygls", "lsprotocol",
}  # fmt: skip
MOST_COMPLEX = 15
MODULES = sorted(PACKAGE.rglob("*.py"))
FOLDERS = sorted({path.parent for path in MODULES} - {PACKAGE})


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text())


@cache
def nodes_of(path: Path) -> tuple[ast.AST, ...]:
    """Everything in a module: to walk through it takes as long as to parse it."""
    return tuple(ast.walk(tree_of(path)))


def package(module: str) -> str:
    return module.split(".")[1] if "." in module else ""


def imports(nodes: Iterable[ast.AST]) -> Iterator[str]:
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module


def imported_at_once(tree: ast.Module) -> Iterator[str]:
    """What importing the module imports: not what stands in functions or under TYPE_CHECKING."""
    for node in tree.body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield from imports([node])


def test_packages_import_only_lower_layers() -> None:
    wrong = []
    for path in MODULES:
        own = path.relative_to(PACKAGE).with_suffix("").parts[0]
        if own not in ("__init__", "__main__"):
            others = (m for m in imports(nodes_of(path)) if m.startswith("tmd.") and package(m) != own)
            wrong += [f"{path} imports {m}" for m in others if LAYER[package(m)] >= LAYER[own]]
    assert not wrong


def test_heavy_packages_are_imported_where_they_are_used() -> None:
    lazy_leaves = {"numba_build.py", "kernel.py", "language_server.py"}
    names = {path: {m.split(".")[0] for m in imported_at_once(tree_of(path))} for path in MODULES}
    assert not {path: found & HEAVY for path, found in names.items() if found & HEAVY and path.name not in lazy_leaves}


def test_modules_say_what_they_are_for_and_stay_small() -> None:
    assert [path for path in MODULES if not ast.get_docstring(tree_of(path))] == []
    assert [path for path in MODULES if len(path.read_text().splitlines()) > 1_000] == []


def imported(path: Path) -> set[str]:
    """The modules of this project that a module imports, in functions and for types as well."""
    found: set[str] = set()
    for node in nodes_of(path):
        if isinstance(node, ast.ImportFrom) and node.module:
            full = {f"{node.module}.{alias.name}" for alias in node.names} & MODULE_NAMES
            found |= full or {node.module} & MODULE_NAMES
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names} & MODULE_NAMES
    return found - {module_of(path)}


def module_of(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULE_NAMES = {module_of(path) for path in MODULES}


def test_inference_knows_neither_grammar_nor_lexicon() -> None:
    found = {(path.name, name) for path in (PACKAGE / "inference").rglob("*.py") for name in imported(path)}
    assert not {pair for pair in found if package(pair[1]) in ("language", "goals")}


def test_no_modules_import_one_another() -> None:
    own = PACKAGE / "__init__.py"  # has names of the highest layers, and imports them when they are asked for
    waiting = {module_of(path): imported(path) for path in MODULES if path != own}
    while ready := [module for module, needs in waiting.items() if not needs & waiting.keys()]:
        for module in ready:
            del waiting[module]
    assert not waiting, f"in or behind a circle: {sorted(waiting)}"


def test_no_two_public_classes_have_one_name() -> None:
    places: dict[str, list[str]] = {}
    for path in MODULES:
        for node in tree_of(path).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places.setdefault(node.name, []).append(str(path.relative_to(PACKAGE)))
    assert {name: found for name, found in places.items() if len(found) > 1} == {}


def test_folders_show_few_names() -> None:
    for folder in FOLDERS:
        names = [path.name for path in folder.iterdir() if not path.name.startswith(("__", "."))]
        most = 17 if folder.name == "commands" else 15  # one module for each command
        assert len(names) <= most, folder


REFERENCE = re.compile(r":(?:mod|class|func|data|meth):`(?:[^`<]+<)?~?(tmd\.[\w.]+)>?`")


def test_references_in_docstrings_name_what_is_there() -> None:
    for path, reference in ((module, found) for module in MODULES for found in REFERENCE.findall(module.read_text())):
        parts = reference.split(".")
        length = max(n for n in range(1, len(parts) + 1) if ".".join(parts[:n]) in MODULE_NAMES)
        value: object = import_module(".".join(parts[:length]))
        for name in parts[length:]:
            fields = getattr(value, "__dataclass_fields__", {})
            assert hasattr(value, name) or name in fields, f"{path}: {reference}"
            value = getattr(value, name, None)


def test_packages_say_where_to_begin() -> None:
    for folder in FOLDERS:
        modules = [path for path in folder.glob("*.py") if not path.name.startswith("__")]
        text = ast.get_docstring(tree_of(folder / "__init__.py")) or ""
        assert len(modules) < 4 or "Begin with" in text or "copy the shortest" in text, folder


@pytest.mark.parametrize(
    "package",
    ["language", "goals", "cli", "editor", "export", "format", "library", "records", "robot_trials", "world", "*.py"],
)
def test_no_function_is_too_complex(package: str) -> None:
    """Cyclomatic complexity as radon counts it: with ``and``, ``or`` and comprehensions."""
    blocks = {
        f"{path.relative_to(PACKAGE)}:{block.lineno} {block.name}": block.complexity
        for path in (PACKAGE.glob(package) if "*" in package else (PACKAGE / package).rglob("*.py"))
        for block in cc_visit(path.read_text())
        if block.letter != "C"
    }
    assert blocks
    assert {name: found for name, found in blocks.items() if found > MOST_COMPLEX} == {}


def test_no_docstring_begins_with_a_question_word() -> None:
    documented = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
    for path in MODULES:
        nodes = (node for node in nodes_of(path) if isinstance(node, documented))
        found = [text.splitlines()[0] for node in nodes if (text := ast.get_docstring(node))]
        wrong = [line for line in found if re.match(r"(What|Who|Where|Which|When|Why|How|Whether)\b", line)]
        assert not wrong, path
