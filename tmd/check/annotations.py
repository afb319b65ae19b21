"""What was found, in the forms that editors and code hosts read.

`SARIF 2.1.0 <https://docs.oasis-open.org/sarif/sarif/v2.1.0/sarif-v2.1.0.html>`_ is read by Visual Studio Code, Visual
Studio, JetBrains' editors, GitHub and GitLab; `workflow commands
<https://docs.github.com/actions/reference/workflow-commands-for-github-actions>`_ make GitHub show each problem beside
its line of a pull request.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path, PurePath
from urllib.parse import quote

from tmd.check.codes import SEVERITY, SUMMARY, Severity
from tmd.check.diagnostic import Diagnostic

SARIF_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_GITHUB = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "notice"}


def sarif(diagnostics: Sequence[Diagnostic], version: str) -> dict[str, object]:
    """A SARIF log of one run: the kinds that occur as rules, each problem as a result.

    Args:
        diagnostics: What was found.
        version: The version of tmd.
    """
    codes = sorted({diagnostic.code for diagnostic in diagnostics})
    rules = [
        {
            "id": code,
            "shortDescription": {"text": SUMMARY.get(code, code)},
            "defaultConfiguration": {"level": str(SEVERITY[code])},
        }
        for code in codes
    ]
    tool = {"driver": {"name": "tmd", "version": version, "rules": rules}}
    results = [_result(diagnostic, codes.index(diagnostic.code)) for diagnostic in diagnostics]
    # columns count characters, not the UTF-16 units that SARIF takes otherwise
    run = {"tool": tool, "columnKind": "unicodeCodePoints", "results": results}
    return {"$schema": SARIF_SCHEMA, "version": "2.1.0", "runs": [run]}


def _result(diagnostic: Diagnostic, rule: int) -> dict[str, object]:
    place = diagnostic.location
    region = {"startLine": place.line, "startColumn": place.column}
    message = diagnostic.message + (f" ({diagnostic.hint})" if diagnostic.hint else "")
    return {
        "ruleId": diagnostic.code,
        "ruleIndex": rule,
        "level": str(diagnostic.severity),
        "message": {"text": message},
        "locations": [{"physicalLocation": {"artifactLocation": {"uri": _uri(place.file)}, "region": region}}],
    }


def _uri(file: str) -> str:
    """Relative files stay relative, as SARIF wants them of files of a repository."""
    return Path(file).as_uri() if Path(file).is_absolute() else quote(PurePath(file).as_posix())


def github(diagnostics: Iterable[Diagnostic]) -> str:
    """One workflow command for each problem."""
    return "".join(
        f"::{_GITHUB[d.severity]} file={_property(d.location.file)},line={d.location.line},col={d.location.column},"
        f"title={_property(d.code)}::{_data(d.message + (f' ({d.hint})' if d.hint else ''))}\n"
        for d in diagnostics
    )


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
