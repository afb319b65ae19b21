"""One reader of PDDL, asked to read a domain and a problem: ``python readers.py TOOL DOMAIN PROBLEM``.

It runs in a process of its own, because some of the readers are GPL and all of them may crash. It ends with 0 where
the reader has nothing to say, and with 1 where it complains; what it says goes to standard output.
"""

from __future__ import annotations

import sys
from importlib.metadata import version


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
    from pathlib import Path

    import up_fast_downward

    found = next(Path(up_fast_downward.__file__).parent.rglob("translate"))
    script = found / "translate.py" if (found / "translate.py").is_file() else found / "__main__.py"
    sys.path[:0] = [str(found.parent.parent), str(found)]
    with tempfile.TemporaryDirectory() as directory:
        sys.argv = [str(script), domain, problem, "--sas-file", f"{directory}/output.sas"]
        runpy.run_path(str(script), run_name="__main__")


TOOLS = {
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
