"""Cases by kind: which file, text, option, variable or stream is damaged, and which command meets it."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from random import Random

import click

from experiments.robustness.mutate import PIECES, damaged
from experiments.robustness.workspace import DOMAINS, EXPERIMENT, PROBLEM, SAID, Case, Workspace
from tmd.cli.program import COMMANDS, program

Maker = Callable[[Workspace, Random], Case]

_ROOM = {"04_tea": "pantry1", "03_drawer": "study1", "02_table": "corner1", "01_blocks": "yard1", "lab_bench": "lab1"}
_SENTENCES = {
    "04_tea": "Heat the kettle.",
    "03_drawer": "Open the drawer.",
    "02_table": "Take the book.",
    "01_blocks": "Hold the red block.",
    "lab_bench": "Take the beaker.",
}


def _named(workspace: Workspace, *beginnings: str, ends: tuple[str, ...] = ("",)) -> list[str]:
    return [n for n in workspace.kept if n.startswith(beginnings or "") and n.endswith(ends)]


def of_domain(workspace: Workspace, choose: Random) -> Case:
    """A file of a domain's folder or beside its problems."""
    kinds = (".pddl", ".yaml", ".json", ".jsonl", ".txt")
    domain = choose.choice(DOMAINS)
    name = choose.choice(_named(workspace, f"domains/{domain}/", f"problems/{domain}/", ends=kinds))
    workspace.damage(name, choose)
    if choose.random() < 0.2:
        workspace.damage(choose.choice(_named(workspace, f"domains/{domain}/", ends=kinds)), choose)
    problems = _named(workspace, f"problems/{domain}/p", ends=(".pddl",))
    environments = _named(workspace, f"problems/{domain}/environments/", ends=(".yaml", ".pddl"))
    room = choose.choice((*environments, _ROOM[domain]))
    text = _SENTENCES[domain]
    ground = ("ground", "--environment", room, "--domain", domain, "--text", text)
    cheap: list[tuple[str, ...]] = [  # a few milliseconds each
        ("compile", domain),
        ("compile", domain),
        ("compile", room, "--output", "problem.pddl"),
        ("fmt", name),
        ("parse", "--text", text, "--domain", domain, "--json"),
        ("check", name, "--json"),
    ]
    dear: list[tuple[str, ...]] = [  # a tenth of a second and more
        ("check", f"domains/{domain}", f"problems/{domain}"),
        ("check", f"domains/{domain}", "--strict", "--json"),
        ("check", name, "--fix"),
        ("fmt", "--check", f"domains/{domain}"),
        (*ground, "--json"),
        (*ground, "--model", "paper", "--guess"),
        (*ground, "--goal-only"),
        ("export", room, "out", "--domain", domain, "--text", text),
        ("scene", "--environment", room, "--domain", domain),
    ]
    if problems and domain != "lab_bench":  # whose problems take two seconds each
        problem = choose.choice(problems)
        planner = choose.choice(("in-process", "fast-downward", "kairos"))
        cheap += 2 * [
            ("validate", domain, problem, "plan.txt", "--json"),
            ("plan", domain, problem, "--planner", "in-process", "--json"),
            ("export", problem, "out", "--plan", "plan.txt"),
        ]
        dear += [
            ("plan", domain, problem, "--planner", planner, "--json", "--time-limit", "10"),
            ("export", problem, "out", "--planner", "in-process"),
            ("view", "plan.txt", "--problem", problem, "--domain", domain, "--out", "page.html"),
        ]
    if name.endswith(".jsonl"):
        cheap += 6 * [("check", name)]
        dear += 2 * [("test", domain), ("learn", domain, "--no-weights", "--out", "learned2")]
    return Case(choose.choice(cheap if choose.random() < 0.93 else dear))


def of_plan(workspace: Workspace, choose: Random) -> Case:
    """A plan, a record that is given back, or the log of a run."""
    name = choose.choice([n for n in ("plan.txt", "ground.json", "log.jsonl") if n in workspace.kept])
    workspace.damage(name, choose)
    if name == "plan.txt":
        return Case(
            choose.choice(
                (
                    *10 * (("validate", "04_tea", PROBLEM, name, "--json"),),
                    ("export", PROBLEM, "out", "--plan", name),
                    ("export", PROBLEM, "out", "--plan", name, "--format", "strips,bt,durative,ipc"),
                    ("view", name, "--problem", PROBLEM, "--out", "page.html"),
                    ("run", "--environment", "kitchen1", "--plan", name, "--kinematic", "--json"),
                )
            )
        )
    view = ("view", name, "--out", "page.html")
    return Case(view if name == "log.jsonl" else choose.choice((view, ("export", name, "out"))))


def of_text(workspace: Workspace, choose: Random) -> Case:
    """What was said."""
    said = damaged(SAID.encode(), choose)
    if choose.random() < 0.93:
        return Case(("parse", "--text-file", "-", *choose.choice(((), ("--json",)))), stdin=said)
    (workspace.folder / "said.txt").write_bytes(said)
    source = ("--environment", "pantry1", "--text-file", "said.txt")
    return Case(
        choose.choice(
            (
                ("ground", *source, "--json", *choose.choice(((), ("--guess",)))),
                ("ground", *source, "--learned", "learned"),
                ("export", "problems/04_tea/environments/pantry1.yaml", "out", "--text-file", "said.txt"),
            )
        )
    )


def of_run(workspace: Workspace, choose: Random) -> Case:
    """A file of a run's directory."""
    name = choose.choice(_named(workspace, "run/", ends=("json", "jsonl", "yaml")))
    workspace.damage(name, choose)
    return Case(
        choose.choice(
            (
                EXPERIMENT,
                *6 * (("view", "run", "--out", "page.html"), ("export", "run", "out")),
                (*EXPERIMENT, "--step", "report"),
                (*EXPERIMENT, "--step", "robot"),
            )
        )
    )


def of_learned(workspace: Workspace, choose: Random) -> Case:
    """What was learned, with checksums that fit."""
    names = [n for n in _named(workspace, "learned/") if not n.endswith("learned.json")]
    workspace.damage(choose.choice(names), choose)
    manifest = json.loads(workspace.kept["learned/04_tea/learned.json"])
    folder = workspace.folder / "learned" / "04_tea"
    manifest["files"] = {n: hashlib.sha256((folder / n).read_bytes()).hexdigest() for n in manifest["files"]}
    (folder / "learned.json").write_text(json.dumps(manifest))
    if choose.random() < 0.1:
        workspace.damage("learned/04_tea/learned.json", choose)
    model = choose.choice(("goals", "policy", "paper"))
    return Case(
        ("ground", "--environment", "pantry1", "--text", SAID, "--learned", "learned", "--model", model, "--json")
    )


_EXTERNAL = b'<!DOCTYPE d [<!ENTITY f SYSTEM "file:///etc/passwd"><!ENTITY % p SYSTEM "http://localhost:9/x">%p;]>'
_LAUGHS = (
    b'<!DOCTYPE d [<!ENTITY a0 "aaaaaaaaaa">'
    + b"".join(b'<!ENTITY a%d "%s">' % (n, b"&a%d;" % (n - 1) * 10) for n in range(1, 10))
    + b"]>"
)


def of_veil(workspace: Workspace, choose: Random) -> Case:
    """A file of VEIL-500: damaged, with entities that grow, or that name other files."""
    name = choose.choice(_named(workspace, "veil/"))
    data = workspace.kept[name]
    kind = choose.randrange(4)
    if kind == 0:
        place = data.index(b">") + 1
        data = choose.choice((_LAUGHS, _EXTERNAL)) + data[:place] + choose.choice((b"&a9;", b"&f;")) + data[place:]
    elif kind == 1:
        data = choose.choice((_LAUGHS, _EXTERNAL)) + damaged(data, choose)
    else:
        data = damaged(data, choose)
    (workspace.folder / name).write_bytes(data)
    experiment = ("experiment", "--task", "all", "--data", "veil500", "--veil500", "veil", "--out", "veil-run")
    return Case(
        choose.choice(
            (
                ("ground", "--environment", "veil/Environments/kitchen/kitchen2.xml", "--text", "Take the mug."),
                (*experiment, "--models", "empty", "--jobs", "1"),
            )
        )
    )


def of_bombs(workspace: Workspace, choose: Random) -> Case:
    """Small files that grow when they are read: anchors, depth, long numbers, many of one thing."""
    size = choose.choice((10, 100, 1_000, 10_000))
    yaml = (
        "a0: &a0 [x, x]\n" + "".join(f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]\n" for n in range(1, 12)),
        "a: &a\n  b: *a\n",
        "<<: &a {<<: *a}\n",
        "objects: " + "[" * size,
        "objects: " + "{a: " * size,
        "x: " + "9" * size,
        "- " * size,
        "? " * size,
        "".join(f"k{n}: v\n" for n in range(size)),
        "a: !!python/object/apply:os.system ['true']\n",
        "a: !!binary " + "A" * size,
        "a: 1e" + "9" * size,
        "a: |\n" + " " * size + "x\n",
    )
    pddl = (
        "(" * size,
        "(define (domain d) (:types " + " ".join(f"t{n} - t{n + 1}" for n in range(size)) + "))",
        "(define (domain d) (:predicates (p " + " ".join(f"?x{n}" for n in range(size)) + ")))",
        "(define (domain d) (:requirements :adl) (:predicates (p ?x)) (:action a :parameters ("
        + " ".join(f"?x{n}" for n in range(min(size, 300)))
        + ") :effect (p ?x0)))",
        "(define (domain d) (:predicates (p)) (:action a :parameters () :precondition " + "(not " * size,
        "(define (domain d) (:action a :parameters () :effect (increase (total-cost) " + "9" * size + ")))",
        ";" * size,
        "(define (domain d) " + "(:predicates (p))" * size + ")",
    )
    records = ("[" * size, '{"a":' * size, '{"id": ' + "9" * size + "}", '"' + "\\ud800" * size + '"', "{}\n" * size)
    names = {".yaml": yaml, ".pddl": pddl, ".json": records, ".jsonl": records}
    suffix = choose.choice(list(names))
    name = choose.choice([n for n in _named(workspace, ends=(suffix,)) if not n.startswith("learned/")])
    content = choose.choice(names[suffix]).encode()
    if choose.random() < 0.3:
        old = workspace.kept[name]
        place = choose.randrange(len(old) + 1)
        content = old[:place] + content + old[place:]
    (workspace.folder / name).write_bytes(content)
    domain = next((d for d in DOMAINS if f"/{d}/" in name), "04_tea")
    room = ("--environment", _ROOM[domain], "--domain", domain, "--text", _SENTENCES[domain])
    commands = [
        *3 * [("check", name, "--json"), ("fmt", name), ("compile", domain)],
        ("check", f"domains/{domain}", f"problems/{domain}"),
        ("ground", *room, "--json"),
        ("plan", f"domains/{domain}", PROBLEM, "--planner", "in-process"),
        ("view", name, "--out", "page.html"),
        ("export", name, "out", "--planner", "in-process"),
        ("validate", domain, name, name),
    ]
    return Case(choose.choice(commands))


_NAMES = (
    "a\nb", "-x", "--help", "-", "a\tb", "\x1b[31mred", "a b", "ünï", "日本", "a" * 255, "a" * 256, "%s", "{x}",
    "a'b\"c", "concat:x|y", "file:x", "~", "$HOME", "..", "a\\b", "\u202egnp", "a\r", "*", "[x]", "x\udcff", " ", "nul",
)  # fmt: skip


def of_names(workspace: Workspace, choose: Random) -> Case:
    """Files and folders whose names have line ends, control characters, dashes at the beginning, too many letters."""
    stem = choose.choice(_NAMES)
    source = choose.choice(("plan.txt", PROBLEM, "ground.json", "problems/04_tea/environments/pantry1.yaml"))
    suffix = Path(source).suffix
    name = stem + choose.choice((suffix, suffix, ""))
    if choose.random() < 0.3:
        name = os.path.join(choose.choice(_NAMES[:9]), name)  # noqa: PTH118 - a Path would lose dots
    inside = f"./{name}" if choose.random() < 0.4 else name
    try:
        path = workspace.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(workspace.kept[source])
        if choose.random() < 0.4:
            path.write_bytes(damaged(workspace.kept[source], choose))
    except OSError:
        pass  # the command meets a name that cannot be
    mark = ("--",) if choose.random() < 0.5 else ()
    return Case(
        choose.choice(
            (
                ("check", *mark, inside),
                ("fmt", "--check", *mark, inside),
                ("validate", *mark, "04_tea", PROBLEM, inside),
                ("plan", "--planner", "in-process", "--output", inside, "04_tea", PROBLEM),
                ("plan", "--planner", "in-process", *mark, "04_tea", inside),
                ("export", "--planner", "in-process", PROBLEM, inside),
                ("export", *mark, inside, "out"),
                ("view", "--out", inside, "ground.json"),
                ("view", "--out", "page.html", *mark, inside),
                ("ground", "--environment", inside, "--text", "Heat the kettle.", "--json"),
                ("ground", "--environment", "pantry1", "--text-file", inside),
                ("compile", "problems/04_tea/environments/pantry1.yaml", "--output", inside),
                ("learn", "01_blocks", "--no-weights", "--out", inside),
                ("new", *mark, inside),
                ("test", "--cases", inside),
                ("scene", "--environment", inside),
                ("run", "--environment", "kitchen1", "--text", "Take the pot.", "--video", inside, "--log", inside),
                ("--domains", inside, "plan", "--planner", "in-process", "04_tea", PROBLEM),
                ("--problems", inside, "ground", "--environment", "pantry1", "--text", "Heat the kettle."),
            )
        )
    )


_VALUES = (
    "", "-1", "0", "1", "2", "1e9", "nan", "inf", "1/0", "9-1", "9" * 400, "x", "../../x", "a\nb", "-", "/dev/full",
    "/dev/null", "loop/x", "\udcff", "04_tea", "pantry1", "(and)", "(not", "up:x", "all", "/proc/nowhere/x", "plan.txt",
    "ground.json", "run", "said.txt", PROBLEM, "domains/04_tea", "learned", "tcp://127.0.0.1:1", "2/1", "1/3",
    "problems/04_tea/environments/pantry1.yaml", "kitchen", "goals", "paper", "in-process", "Heat the kettle.",
)  # fmt: skip
_GOOD = {
    "environment": "pantry1",
    "text": "Heat the kettle.",
    "domain": "04_tea",
    "domain_name": "04_tea",
    "problem": PROBLEM,
    "plan": "plan.txt",
    "plan_file": "plan.txt",
    "planner": "in-process",
    "source": "plan.txt",
    "directory": "out",
    "paths": "domains/04_tea",
    "task": "tea",
    "models": "empty",
    "out": "out",
    "output": "out.txt",
    "jobs": "1",
    "seconds": "5",
    "text_file": "said.txt",
    "cases": "problems/04_tea/requests.sentences.jsonl",
    "port": "0",
    "learned": "learned",
}
_SLOW = {
    "run": 0.05, "studio": 0.02, "experiment": 0.2, "learn": 0.2, "test": 0.2, "scene": 0.1, "view": 0.3, "ground": 0.3,
    "export": 0.5, "plan": 0.4, "check": 0.5,
}  # fmt: skip


def of_options(workspace: Workspace, choose: Random) -> Case:
    """Every command with any of its options and arguments, and values that may fit or not."""
    loop = workspace.folder / "loop"
    if not loop.is_symlink():
        loop.symlink_to("loop")
    name = choose.choice([c for c in COMMANDS if choose.random() < _SLOW.get(c, 1.0)] or ["parse"])
    context = click.Context(program)
    command = program.get_command(context, name)
    assert command is not None
    arguments = [name]
    if isinstance(command, click.Group):
        inner = choose.choice(command.list_commands(context))
        arguments.append(inner)
        found = command.get_command(context, inner)
        assert found is not None
        command = found
    for parameter in command.params:
        likely = 0.95 if parameter.required else 0.2
        if parameter.name in ("help", "gui") or choose.random() > likely:
            continue
        if parameter.name == "models" and name == "experiment":
            likely = 1.0
        good = _GOOD.get(parameter.name or "")
        value = good if good is not None and choose.random() < 0.7 else choose.choice(_VALUES)
        if choose.random() < 0.05:
            value = choose.choice(PIECES).decode("utf-8", "surrogateescape").replace("\0", "")
        if isinstance(parameter, click.Argument):
            arguments.append(value)
        elif isinstance(parameter, click.Option) and parameter.is_flag:
            arguments.append(choose.choice([*parameter.opts, *parameter.secondary_opts]))
        else:
            arguments += [choose.choice(parameter.opts), value]
    if name == "experiment" and "--models" not in arguments:
        arguments += ["--models", "empty"]
    if name == "experiment" and "--jobs" not in arguments:
        arguments += ["--jobs", "1"]  # processes end with the program, and a child of ours does many cases
    if name == "learn":
        arguments.append("--no-weights")
    before: Sequence[str] = ()
    if choose.random() < 0.1:
        before = (choose.choice(("--domains", "--problems")), choose.choice(("domains", "problems", *_VALUES)))
    return Case((*before, *arguments), choose.choice((b"", SAID.encode(), b"\xff\0")), hold=name == "studio")


_VARIABLES = (
    "HOME", "XDG_CACHE_HOME", "XDG_STATE_HOME", "TMPDIR", "TMD_LEARNED", "VEIL500_DIR", "COLUMNS", "LINES", "TERM",
    "NO_COLOR", "FORCE_COLOR", "TZ", "LANG", "LC_ALL", "PATH", "PYTHONPATH", "DISPLAY", "OMP_NUM_THREADS",
    "NUMBA_CACHE_DIR", "NUMBA_DISABLE_JIT", "MPLCONFIGDIR", "MPLBACKEND", "IMAGEIO_FFMPEG_EXE", "JOBLIB_TEMP_FOLDER",
    "TMD_STUDIO_STATE", "TMD_PROGRAM", "USER", "LOGNAME", "PYDANTIC_DISABLE_PLUGINS",
)  # fmt: skip
_SET = ("", "x", "/proc/nowhere", "/dev/null", "/proc", "a\nb", "9" * 300, "-1", "\udcff", "said.txt", "loop", "~", ".")


def of_environment(workspace: Workspace, choose: Random) -> Case:
    """Environment variables that are set to something else, and standard streams that are closed, full or gone."""
    given: dict[str, str | None] = {}
    for _ in range(choose.choice((0, 1, 1, 2, 4))):
        given[choose.choice(_VARIABLES)] = choose.choice((None, *_SET))
    streams = {n: choose.choice(("closed", "full", "gone")) for n in range(3) if choose.random() < 0.4}
    if not given and not streams:
        streams[choose.randrange(3)] = "closed"
    pantry = ("--environment", "pantry1", "--text-file", choose.choice(("-", "said.txt")))
    planner = choose.choice(("in-process", "fast-downward", "kairos", "up:fast-downward"))
    commands: tuple[tuple[str, ...], ...] = (
        ("parse", "--text-file", "-", "--json"),
        ("parse", "--text-file", "-"),
        ("ground", *pantry),
        ("ground", *pantry, "--json", "--guess"),
        ("ground", "--environment", "pantry1", "--text", "Heat the kettle.", "--goal-only"),
        ("view", "-", "--out", "page.html"),
        ("check", "domains/04_tea", "--json"),
        ("check", "domains", "--json"),
        ("fmt", "domains/04_tea"),
        ("compile", "04_tea"),
        ("plan", "04_tea", PROBLEM, "--planner", planner, "--time-limit", "20"),
        ("validate", "04_tea", PROBLEM, "plan.txt", "--json"),
        ("export", PROBLEM, "out", "--format", "adl,json", "--planner", "in-process"),
        ("new", "mine"),
        ("test", "01_blocks"),
        ("learn", "01_blocks", "--no-weights", "--out", "learned2"),
        ("scene", "--environment", "study1"),
        (*EXPERIMENT[:-3], "run2", "--jobs", "1"),
        (*EXPERIMENT, "--step", "report"),
        ("experiment", "--task", "all", "--data", "veil500", "--out", "run3", "--models", "empty", "--jobs", "1"),
        ("--help",),
        ("--version",),
        (choose.choice(COMMANDS), "--help"),
        ("studio", "--port", "0", "--domain", "04_tea") if choose.random() < 0.05 else ("parse",),
        ("run", "--environment", "kitchen1", "--text", "Take the pot.", "--kinematic")
        if choose.random() < 0.03
        else ("run",),
    )
    arguments = choose.choice(commands)
    return Case(arguments, SAID.encode(), streams, given, hold=arguments[0] == "studio")


KINDS: dict[str, tuple[Maker, int]] = {
    "domains, problems, environments": (of_domain, 32),
    "plans, records, logs": (of_plan, 14),
    "texts": (of_text, 22),
    "a run's directory": (of_run, 3),
    "what was learned, checksums fitted": (of_learned, 1),
    "VEIL-500, entities": (of_veil, 12),
    "bombs": (of_bombs, 3),
    "names of files": (of_names, 4),
    "options and arguments": (of_options, 8),
    "variables and streams": (of_environment, 1),
}
"""What makes a case of each kind, and how many of a hundred cases are of it."""


def case(workspace: Workspace, seed: int, number: int) -> tuple[str, Case]:
    """The case of a seed and number: its kind, and the case, for which the workspace is damaged."""
    choose = Random(f"{seed}-{number}")
    kind = choose.choices(list(KINDS), [share for _, share in KINDS.values()])[0]
    return kind, KINDS[kind][0](workspace, choose)
