"""``tmd learn``: library, policy and weights from a domain's demonstrations, kept where ``tmd ground`` finds them."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmd.cli.inputs.options import json_option, learned_option
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.evaluation.learn import LearnedDomain
    from tmd.world.corpus import Corpus


@click.command("learn", short_help="Learn a domain's library, policy and weights from its demonstrations.")
@click.argument("domain", metavar="DOMAIN")
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="DIR",
    help="Save in DIR/DOMAIN, for `tmd ground --learned DIR`; learned/ beside the demonstrations by default.",
)
@learned_option
@click.option("--no-weights", is_flag=True, help="Learn no weights, which takes by far the longest.")
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Random seed.")
@json_option
@click.pass_obj
def command(
    roots: Roots, domain: str, out: Path | None, learned: Path | None, no_weights: bool, seed: int, as_json: bool
) -> ExitCode:
    """Learn from the demonstrations of DOMAIN, and save it.

    `tmd ground` uses what was saved for as long as the domain, its environments and demonstrations, and tmd itself, are
    what it was learned from; otherwise it learns again each time. The weights are used when asked for:
    `tmd ground --weights learned`.
    """
    from tmd.evaluation.learn import learn_domain

    if not no_weights and sys.stderr.isatty():
        emit("the weights take a while to learn; --no-weights leaves them out\n", error=True)
    corpus = roots.corpus(roots.folder(domain))
    report = _report(corpus, learn_domain(corpus, out or learned, weights=not no_weights, seed=seed))
    if as_json:
        emit_json(report)
    else:
        emit(_text(report))
    return ExitCode.OK


def _report(corpus: Corpus, found: LearnedDomain) -> dict[str, object]:
    from tmd.json_record import rounded

    library, reward = found.knowledge.library, found.knowledge.reward
    verbs = sorted(library.verbs(), key=lambda verb: (-len(library.templates(verb)), verb))
    curve = found.tuned.curve if found.tuned else ()
    return {
        "domain": corpus.folder.name,
        "demonstrations": len(corpus.demonstrations()),
        "goals": sum(d.goal is not None for d in corpus.demonstrations()),
        "environments": sorted({d.environment for d in corpus.demonstrations()}),
        "templates": {verb: len(library.templates(verb)) for verb in verbs},
        "unaligned": len(library.unaligned),
        "policy": {"before": rounded(reward.before), "after": rounded(reward.after)} if reward else None,
        "weights": {"before": rounded(curve[0]["loss"]), "after": rounded(min(p["loss"] for p in curve))}
        if curve
        else None,
        "saved": str(found.directory),
    }


def _text(report: dict[str, object]) -> str:
    templates, places = report["templates"], report["environments"]
    assert isinstance(templates, dict)
    assert isinstance(places, list)
    width = max(map(len, templates), default=0)
    lines = [
        f"{report['domain']}: {report['demonstrations']} demonstrations in {', '.join(places)}",
        f"{sum(templates.values())} templates",
        *(f"  {verb:<{width}}  {count:>4}" for verb, count in templates.items()),
    ]
    if report["unaligned"]:
        lines.append(f"{report['unaligned']} pieces of text with instructions, but without a verb, taught nothing")
    for name, what in (("policy", "mean ln P of what was shown"), ("weights", "mean loss of the plans chosen")):
        part = report[name]
        if isinstance(part, dict):
            lines.append(f"{name}: {what} {part['before']:.4f} before, {part['after']:.4f} after")
    return "\n".join([*lines, f"saved in {report['saved']}"]) + "\n"
