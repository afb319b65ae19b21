"""A package imports only packages of lower layers, no two modules import one another, and folders stay small."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "tmd"
LAYERS = (
    ("diagnostics",),
    ("files",),
    ("pddl", "language"),
    ("world", "planning", "format"),
    ("veil", "datasets", "robot"),
    ("goals",),
    ("inference",),
    ("ground", "export"),
    ("api", "view", "evaluation"),
    ("check", "robot_trials", "studio"),
    ("cli",),
)
"""From the lowest to the highest; nothing imports from its own layer but its own package."""
LAYER = {package: number for number, layer in enumerate(LAYERS) for package in layer}
HEAVY = {
    "unified_planning", "up_fast_downward", "numba", "pybullet", "rich", "joblib",
    "matplotlib", "jinja2", "scipy", "distributed", "dask", "imageio", "PIL", "ikfast_pr2", "pr2_ikfast",
    "viser", "trimesh",
}  # fmt: skip
MODULES = sorted(PACKAGE.rglob("*.py"))


def package(module: str) -> str:
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
def test_packages_import_only_lower_layers(path: Path) -> None:
    own = path.relative_to(PACKAGE).with_suffix("").parts[0]
    if own in ("__init__", "__main__"):
        return
    for module in imports(ast.parse(path.read_text())):
        if module.startswith("tmd.") and package(module) != own:
            assert LAYER[package(module)] < LAYER[own], f"{own} imports {module}"


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_heavy_packages_are_imported_where_they_are_used(path: Path) -> None:
    found = {module.split(".")[0] for module in imported_at_once(ast.parse(path.read_text()))}
    lazy_leaf = path.name in {"numba_build.py", "kernel.py"}
    assert lazy_leaf or not found & HEAVY


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_modules_say_what_they_are_for_and_stay_small(path: Path) -> None:
    text = path.read_text()
    assert ast.get_docstring(ast.parse(text)), "no docstring"
    assert len(text.splitlines()) <= 500
