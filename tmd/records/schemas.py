"""Every JSON format as JSON Schema, made of the classes that write and read it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic import TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

from tmd.files import make_directory, write_text
from tmd.format.json_layout import lay_out
from tmd.readers.llm.reply import Reply
from tmd.records.clauses import ParsedRecord
from tmd.records.fit import Fit
from tmd.records.grounding import GoalOnlyRecord, GroundingRecord
from tmd.records.metrics import Metrics
from tmd.records.prediction import PredictionRecord
from tmd.records.provenance import Provenance
from tmd.records.run import RunEvent, RunRecord
from tmd.records.sentence_test import SentenceReport
from tmd.records.trajectory import TrajectoryLine
from tmd.records.trial import Trial

# The formats by name. Of ``run-log``, ``prediction`` and ``trajectory``, JSON Lines, it is the format of a line.
FORMATS: dict[str, Any] = {
    "parse": ParsedRecord,
    "grounding": GroundingRecord,
    "goal-only": GoalOnlyRecord,
    "run": RunRecord,
    "run-log": RunEvent,
    "test": SentenceReport,
    "llm-reply": Reply,
    "prediction": PredictionRecord,
    "metrics": Metrics,
    "fit": Fit,
    "provenance": Provenance,
    "trial": Trial,
    "trajectory": TrajectoryLine,
}


def schema_text(name: str) -> str:
    """Return the JSON Schema of a format."""
    return lay_out(TypeAdapter(FORMATS[name]).json_schema(schema_generator=_WithoutTitles)) + "\n"


class _WithoutTitles(GenerateJsonSchema):
    """Generator of schemas without titles, which would only repeat the keys."""

    def field_title_should_be_set(self, schema: Any) -> bool:  # noqa: ANN401 - a schema of pydantic's core
        """Return false."""
        return False


def write_schemas(directory: Path) -> None:
    """Write ``NAME.schema.json`` for each format.

    Raises:
        OutputError: They cannot be written.
    """
    make_directory(directory)
    for name in FORMATS:
        write_text(directory / f"{name}.schema.json", schema_text(name))
