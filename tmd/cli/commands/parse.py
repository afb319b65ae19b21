"""``tmd parse``: text to clauses."""

from __future__ import annotations

import click

from tmd.cli.inputs.options import json_option, said, text_options
from tmd.cli.output import emit, emit_json
from tmd.world.roots import Roots


@click.command("parse", short_help="Split a text into verb clauses.")
@text_options
@click.option("--domain", "domain_name", metavar="NAME", help="Use the words of this domain as well.")
@json_option
@click.pass_obj
def command(roots: Roots, text: str | None, text_file: str | None, domain_name: str | None, as_json: bool) -> None:
    """Split a text into verb clauses, and show what no clause accounts for."""
    from tmd.cli.show.grounding import parsed_text
    from tmd.language import parse

    parsed = parse(said(text, text_file), roots.lexicon(domain_name) if domain_name else None)
    if as_json:
        from tmd.records.clauses import ParsedRecord

        emit_json(ParsedRecord.of(parsed).to_value())
    else:
        emit(parsed_text(parsed))
