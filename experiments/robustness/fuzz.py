"""Damaged files, texts, options and streams for the commands; each case runs in a process of its own."""

from __future__ import annotations

import hashlib
import json
import os
import resource
import shutil
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from random import Random

from experiments.robustness.mutate import damaged, damaged_json
from tmd.cli.program import run as run_tmd
from tmd.diagnostics import ExitCode

ROOT = Path(__file__).resolve().parents[2]
SECONDS = 60.0
"""No command on a damaged small file takes longer on a busy machine."""
MEMORY = 4_000_000_000
_EXPERIMENT = (
    *("experiment", "--task", "tea", "--domain", "04_tea"),
    *("--models", "empty,chance", "--out", "run", "--jobs", "1"),
)
_SAID = "Fill the kettle with water. Heat it on the stove, then put the cup on the table."
_XML = (
    '<?xml version="1.0"?><!DOCTYPE d [<!ENTITY a "aaaaaaaaaa">'
    + "".join(f'<!ENTITY a{n} "{f"&a{n - 1 or str()};" * 10}">' for n in range(1, 10))
    + '<!ENTITY f SYSTEM "file:///etc/passwd">]><d>&a9;&f;</d>'
)


@dataclass(frozen=True, slots=True)
class Case:
    """A command, and the damage that is done before it in a fresh copy of :class:`Ground`."""

    arguments: tuple[str, ...]
    stdin: bytes = b""
    closed: tuple[int, ...] = ()


@dataclass(slots=True)
class Outcome:
    """How a case ended: ``fault`` says what is wrong with that, empty where nothing is."""

    code: int
    seconds: float
    fault: str
    told: str


@dataclass(slots=True)
class Ground:
    """A folder with a small domain, its problems, a run, learned files and records, to be damaged case by case."""

    folder: Path
    kept: dict[str, bytes] = field(default_factory=dict)

    def prepare(self) -> None:
        """Make the folder; needs some ten seconds."""
        for module in (
            "check.checker",
            "domain_kit",
            "export.formats",
            "evaluation.report.report",
            "view.page",
            "ground",
        ):
            import_module(f"tmd.{module}")  # once here, and not again in each child
        self.folder.mkdir(parents=True)
        for kind in ("domains", "problems"):
            shutil.copytree(ROOT / kind / "04_tea", self.folder / kind / "04_tea")
        (self.folder / "said.txt").write_text(_SAID)
        veil = self.folder / "veil"
        veil.mkdir()
        (veil / "Environments").mkdir()
        for name in ("data.xml", "Objects.xml"):
            (veil / name).write_text(_XML)
        problem = "problems/04_tea/p01-tea-pantry1.pddl"
        for arguments in (
            ("plan", "04_tea", problem, "--output", "plan.txt"),
            ("export", problem, "plan", "--format", "json"),
            ("learn", "04_tea", "--no-weights", "--out", "learned"),
            (
                "experiment",
                "--task",
                "tea",
                "--domain",
                "04_tea",
                "--models",
                "empty,chance",
                "--out",
                "run",
                "--jobs",
                "1",
            ),
        ):
            self.run(Case(arguments))
        self.run(Case(("ground", "--environment", "pantry1", "--text", _SAID, "--guess", "--json")), "ground.json")
        self.kept = {str(path.relative_to(self.folder)): path.read_bytes() for path in self._files()}

    def _files(self) -> list[Path]:
        return sorted(path for path in self.folder.rglob("*") if path.is_file() and not path.is_symlink())

    def restore(self) -> None:
        """Undo the damage."""
        for path in self._files():
            name = str(path.relative_to(self.folder))
            if name not in self.kept:
                path.unlink()
        for name, data in self.kept.items():
            path = self.folder / name
            if not path.is_file() or path.read_bytes() != data:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(data)

    def run(self, case: Case, keep: str = "") -> Outcome:
        """Run a case in a child of this process."""
        out, err = self.folder.parent / "stdout", self.folder.parent / "stderr"
        begun = time.monotonic()
        child = os.fork()
        if child == 0:
            self._become(case, out, err)
        _, status = os.waitpid(child, 0)
        seconds = time.monotonic() - begun
        code = os.waitstatus_to_exitcode(status)
        printed, told = out.read_bytes(), err.read_bytes().decode("utf-8", "replace")
        if keep:
            (self.folder / keep).write_bytes(printed)
        return Outcome(code, seconds, _fault(case, code, printed, told), told)

    def _become(self, case: Case, out: Path, err: Path) -> None:
        """Never returns."""
        try:
            os.chdir(self.folder)
            reading, writing = os.pipe()
            os.write(writing, case.stdin[:60_000])
            os.close(writing)
            targets = [os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC) for path in (out, err)]
            for number, opened in enumerate((reading, *targets)):
                os.dup2(opened, number)
            sys.stdin, sys.stdout, sys.stderr = open(0), open(1, "w"), open(2, "w")  # noqa: SIM115 - kept
            for number in case.closed:  # as tmd.cli.output finds them
                os.dup2(os.open(os.devnull, os.O_RDWR), number)
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            signal.signal(signal.SIGALRM, signal.SIG_DFL)
            signal.setitimer(signal.ITIMER_REAL, SECONDS)
            os.environ["XDG_CACHE_HOME"] = str(self.folder.parent / "cache")
            code = int(run_tmd(case.arguments))
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(code)
        except BaseException as error:
            os.write(2, f"Traceback: {error!r}".encode())
        finally:
            os._exit(99)


def _fault(case: Case, code: int, printed: bytes, told: str) -> str:
    """What is wrong with how a case ended."""
    if code == -signal.SIGALRM:
        return f"over {SECONDS:.0f} s"
    if code == ExitCode.INTERNAL or "Traceback" in told:
        return "internal error"
    if code not in set(ExitCode):
        return f"code {code}"
    if "site-packages" in told or "Warning:" in told:
        return "a warning of Python"
    if "--json" in case.arguments and case.closed == ():
        try:
            json.loads(printed)
        except ValueError:
            if code != ExitCode.USAGE or printed:
                return "broken JSON"
    if code >= ExitCode.USAGE and code != ExitCode.INTERRUPTED and not told.strip() and case.closed == ():
        return "no message"
    return ""


Maker = Callable[[Ground, Random], Case]


def _change(ground: Ground, choose: Random, name: str) -> None:
    data = ground.kept[name]
    json_like = name.endswith((".json", ".jsonl"))
    try:
        changed = damaged_json(data, choose) if json_like and choose.random() < 0.7 else damaged(data, choose)
    except (ValueError, IndexError):
        changed = damaged(data, choose)
    (ground.folder / name).write_bytes(changed)


def of_domain(ground: Ground, choose: Random) -> Case:
    """A file of the domain's folder or beside its problems."""
    folder = [n for n in ground.kept if n.startswith(("domains", "problems")) and not n.endswith((".md", ".nl"))]
    name = choose.choice(folder)
    _change(ground, choose, name)
    environment = ("--environment", choose.choice(("pantry1", "problems/04_tea/environments/pantry1.yaml")))
    return Case(
        choose.choice(
            (
                ("check", "domains/04_tea", "problems/04_tea"),
                ("check", name, "--json"),
                ("fmt", name),
                ("fmt", "--check", name),
                ("compile", "04_tea"),
                ("plan", "04_tea", "problems/04_tea/p01-tea-pantry1.pddl", "--json"),
                ("validate", "04_tea", "problems/04_tea/p01-tea-pantry1.pddl", "plan.txt"),
                ("ground", *environment, "--text", _SAID, "--json"),
                ("export", "problems/04_tea/p01-tea-pantry1.pddl", "out", "--plan", "plan.txt"),
                ("test", "04_tea"),
                ("view", name, "--out", "page.html"),
            )
        )
    )


def of_plan(ground: Ground, choose: Random) -> Case:
    """A plan, or a record that is given back."""
    name = choose.choice(("plan.txt", "plan/plan.json", "ground.json"))
    name = name if name in ground.kept else "plan.txt"
    _change(ground, choose, name)
    if name == "plan.txt":
        return Case(("validate", "04_tea", "problems/04_tea/p01-tea-pantry1.pddl", name, "--json"))
    return Case(
        choose.choice(
            (("export", name, "out"), ("view", name, "--out", "page.html"), ("export", name, "out", "--json"))
        )
    )


def of_text(ground: Ground, choose: Random) -> Case:
    """What was said."""
    said = damaged(_SAID.encode(), choose)
    if choose.random() < 0.5:
        return Case(("parse", "--text-file", "-", *choose.choice(((), ("--json",)))), stdin=said)
    (ground.folder / "said.txt").write_bytes(said)
    return Case(
        ("ground", "--environment", "pantry1", "--text-file", "said.txt", "--json", *choose.choice(((), ("--guess",))))
    )


def of_run(ground: Ground, choose: Random) -> Case:
    """A file of a run's directory."""
    _change(
        ground,
        choose,
        choose.choice([n for n in ground.kept if n.startswith("run/") and n.endswith(("json", "jsonl"))]),
    )
    same = (
        "experiment",
        "--task",
        "tea",
        "--domain",
        "04_tea",
        "--models",
        "empty,chance",
        "--out",
        "run",
        "--jobs",
        "1",
    )
    return Case(
        choose.choice(((*same, "--step", "report"), ("view", "run", "--out", "page.html"), ("export", "run", "out")))
    )


def of_learned(ground: Ground, choose: Random) -> Case:
    """What was learned, with checksums that fit."""
    names = [n for n in ground.kept if n.startswith("learned/") and not n.endswith("learned.json")]
    for name in choose.sample(names, 1):
        _change(ground, choose, name)
    manifest = json.loads(ground.kept["learned/04_tea/learned.json"])
    folder = ground.folder / "learned" / "04_tea"
    manifest["files"] = {n: hashlib.sha256((folder / n).read_bytes()).hexdigest() for n in manifest["files"]}
    (folder / "learned.json").write_text(json.dumps(manifest))
    model = choose.choice(("goals", "policy", "paper"))
    return Case(
        ("ground", "--environment", "pantry1", "--text", _SAID, "--learned", "learned", "--model", model, "--json")
    )


_OPTIONS = (
    "--top", "--beam", "--trim", "--seed", "--jobs", "--planner", "--model", "--weights", "--domain", "--format",
    "--shard", "--drop-sentences", "--test-environments", "--goal", "--json", "--overwrite", "--environment",
    "--text", "--output",
)  # fmt: skip
_VALUES = (
    "", "-1", "0", "1e9", "nan", "9" * 400, "x", "../../x", "a\nb", "-", "/dev/full", "loop/x", "1/0", "9-1", "\udcff",
    "04_tea", "pantry1", "(and)", "(not", "up:x", "all", "/nowhere/x",
)  # fmt: skip


def of_options(ground: Ground, choose: Random) -> Case:
    """Option values, file names with line ends, closed streams."""
    loop = ground.folder / "loop"
    if not loop.is_symlink():
        loop.symlink_to("loop")
    base: tuple[str, ...] = choose.choice(
        (
            ("ground", "--environment", "pantry1", "--text", "Heat the kettle."),
            ("plan", "04_tea", "problems/04_tea/p01-tea-pantry1.pddl"),
            ("export", "problems/04_tea/p01-tea-pantry1.pddl", "out"),
            ("check", choose.choice(_VALUES)),
            ("parse", "--text", choose.choice(_VALUES)),
            ("fmt", choose.choice(_VALUES)),
            ("new", choose.choice(_VALUES)),
            ("data", "check", choose.choice((*_VALUES, "veil"))),
            ("view", choose.choice(_VALUES), "--out", choose.choice(_VALUES)),
            ("validate", *(choose.choice(_VALUES) for _ in range(3))),
        )
    )
    more: list[str] = []
    for _ in range(choose.choice((0, 1, 1, 2))):
        more += [choose.choice(_OPTIONS), choose.choice(_VALUES)]
    closed = choose.choice(((), (), (), (0,), (1,), (2,), (0, 1, 2)))
    return Case((*base, *more), choose.choice((b"", _SAID.encode(), b"\xff\0")), closed)


KINDS: dict[str, Maker] = {
    "domain and problem files": of_domain,
    "plans and records": of_plan,
    "texts": of_text,
    "a run's directory": of_run,
    "what was learned, checksums fitted": of_learned,
    "options, streams, XML entities": of_options,
}


def save(ground: Ground, case: Case, outcome: Outcome, target: Path) -> None:
    """Keep a failure: the files that differ from the usual ones, the command and what it told."""
    for path in sorted(p for p in ground.folder.rglob("*") if p.is_file() and not p.is_symlink()):
        name = str(path.relative_to(ground.folder))
        if ground.kept.get(name) != path.read_bytes():
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            (target / name).write_bytes(path.read_bytes())
    target.mkdir(parents=True, exist_ok=True)
    told = {"arguments": case.arguments, "closed": case.closed, "code": outcome.code, "fault": outcome.fault}
    told |= {"seconds": round(outcome.seconds, 1), "told": outcome.told[-2_000:]}
    (target / "case.json").write_text(json.dumps(told, indent=1) + "\n")
    (target / "stdin").write_bytes(case.stdin)
