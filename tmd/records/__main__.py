"""``python -m tmd.records DIR``: write the JSON Schema of each format."""

from __future__ import annotations

import sys
from pathlib import Path

from tmd.records.schemas import write_schemas

if __name__ == "__main__":
    write_schemas(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/schemas"))
