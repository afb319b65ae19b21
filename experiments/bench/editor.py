"""How soon the language server shows the diagnostics of a domain of 500 lines after a change.

``python experiments/bench/editor.py`` prints milliseconds from the change that an editor sends to the diagnostics that
it receives, start-up left out: each of 40 edits takes a letter from a name, or gives it back.
"""

from __future__ import annotations

import asyncio
import statistics
import sys
import tempfile
import time
from pathlib import Path

import psutil
from check_speed import domain
from lsprotocol import types as lsp
from pygls.lsp.client import LanguageClient

ROOT = Path(__file__).resolve().parents[2]
ACTIONS, EDITS = 99, 40


async def measured(file: Path) -> list[float]:
    """Seconds for each edit."""
    client = LanguageClient("bench", "1")
    arrived: asyncio.Queue[int] = asyncio.Queue()

    @client.feature(lsp.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
    def take(params: lsp.PublishDiagnosticsParams) -> None:
        arrived.put_nowait(len(params.diagnostics))

    await client.start_io(sys.executable, "-m", "tmd", "lsp", cwd=ROOT)
    await client.initialize_async(lsp.InitializeParams(lsp.ClientCapabilities()))
    client.initialized(lsp.InitializedParams())
    text, uri = file.read_text(), file.as_uri()
    client.text_document_did_open(lsp.DidOpenTextDocumentParams(lsp.TextDocumentItem(uri, "pddl", 0, text)))
    await arrived.get()
    times = []
    before = processor()
    for number in range(1, EDITS + 1):
        changed = text.replace("(made50 ?x) (at", "(made5 ?x) (at" if number % 4 else "(mad50 ?x) (at")
        document = lsp.VersionedTextDocumentIdentifier(number, uri)
        change = lsp.TextDocumentContentChangeWholeDocument(changed if number % 2 else text)
        start = time.perf_counter()
        client.text_document_did_change(lsp.DidChangeTextDocumentParams(document, [change]))
        await arrived.get()
        times.append(time.perf_counter() - start)
    print(f"processor time of the server for an edit: {1000 * (processor() - before) / EDITS:.0f} ms")
    await client.shutdown_async(None)
    client.exit(None)
    await client.stop()
    return times


def processor() -> float:
    """Seconds of processor time that the server has used; others may use the machine."""
    used = [child.cpu_times() for child in psutil.Process().children()]
    return sum(times.user + times.system for times in used)


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as directory:
        file = Path(directory) / "domain.pddl"
        file.write_text(domain(ACTIONS))
        lines = len(file.read_text().splitlines())
        times = [1000 * seconds for seconds in asyncio.run(measured(file))]
    print(f"{lines} lines, {EDITS} edits: median {statistics.median(times):.0f} ms, longest {max(times):.0f} ms")


if __name__ == "__main__":
    main()
