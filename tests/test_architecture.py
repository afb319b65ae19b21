"""A room imports only rooms below it, and heavy packages are imported only where they are used."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "tmd"
FLOORS = {
    "errors": 0,
    "atomic": 0.5,
    "pddl": 1,
    "world": 2,
    "language": 2,
    "planning": 3,
    "veil": 3,
    "goals": 3.5,
    "energy": 4,
    "policy": 4,
    "learned": 4.4,
    "ground": 4.5,
    "sentences": 4.7,
    "evaluation": 5,
    "export": 5,
    "view": 5,
    "robot": 5,
    "api": 5.5,
    "trial": 5.5,
    "check": 5.5,
    "studio": 5.7,
    "cli": 6,
}
HEAVY = {
    "unified_planning", "up_fast_downward", "numba", "pybullet", "rich", "joblib",
    "matplotlib", "jinja2", "scipy", "distributed", "dask", "imageio", "PIL", "ikfast_pr2", "pr2_ikfast",
    "viser", "trimesh",
}  # fmt: skip
MODULES = sorted(PACKAGE.rglob("*.py"))


def room(module: str) -> str:
    return module.split(".")[1] if "." in module else ""


def imports(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module


def imported_at_once(tree: ast.Module) -> Iterator[str]:
    """What importing the module imports: not what stands in functions or under TYPE_CHECKING."""
    for node in tree.body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield from imports(node)


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_rooms_know_only_the_rooms_below(path: Path) -> None:
    own = path.relative_to(PACKAGE).with_suffix("").parts[0]
    if own in ("__init__", "__main__"):
        return
    for module in imports(ast.parse(path.read_text())):
        if module.startswith("tmd.") and room(module) != own:
            assert FLOORS[room(module)] < FLOORS[own], f"{own} imports {module}"


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_heavy_packages_are_imported_where_they_are_used(path: Path) -> None:
    found = {module.split(".")[0] for module in imported_at_once(ast.parse(path.read_text()))}
    lazy_leaf = path.name in {"compiled.py", "kernel.py"}
    assert lazy_leaf or not found & HEAVY


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_modules_say_what_they_are_for_and_stay_small(path: Path) -> None:
    text = path.read_text()
    assert ast.get_docstring(ast.parse(text)), "no docstring"
    assert len(text.splitlines()) <= 500
