"""``tmd lsp`` as an editor sees it: a client, the server in a process of its own, and files on the disk."""

from __future__ import annotations

import asyncio
import json
import os
import random
import re
import subprocess
import sys
from collections.abc import AsyncIterator, Sequence
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tmd.check.report import check_paths
from tmd.format.pddl_layout import format_pddl

pytest.importorskip("pytest_lsp")
import pytest_asyncio
import pytest_lsp
from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcException
from pytest_lsp import ClientServerConfig, LanguageClient, client_capabilities

pytestmark = pytest.mark.asyncio(loop_scope="module")
SERVER = ClientServerConfig([sys.executable, "-m", "tmd", "lsp"], server_env={**os.environ, "PYTHONPATH": str(ROOT)})

DOMAIN = """(define (domain ferry)
  (:requirements :strips :typing :negative-preconditions)
  (:types car boat port)
  (:constants harbour - port) ; the home port
  (:predicates
    (parked ?c - car ?p - port)
    (aboard ?c - car ?b - boat) ; the car is on the boat
    (moored ?b - boat ?p - port))
  (:action embark
    :parameters (?c - car ?b - boat ?p - port)
    :precondition (and (parked ?c ?p) (moored ?b ?p))
    :effect (and (aboard ?c ?b) (not (parked ?c ?p))))
  (:action sail
    :parameters (?b - boat ?from ?to - port)
    :precondition (and (moored ?b ?from) (not (moored ?b ?to)))
    :effect (and (moored ?b ?to) (not (moored ?b ?from))))
  (:action debark
    :parameters (?c - car ?b - boat ?p - port)
    :precondition (and (aboard ?c ?b) (moored ?b ?p))
    :effect (and (parked ?c ?p) (not (aboard ?c ?b)))))
"""
PROBLEM = """(define (problem one) (:domain ferry)
  (:objects red_car - car tug - boat island - port)
  (:init (parked red_car island) (moored tug island))
  (:goal (parked red_car harbour)))
"""
LEXICON = """goals:
  # moor is a word of this domain
  - moor X at Y: (moored ?x ?y)
"""


class Editor:
    """What an editor does with one server; files lie in ``folder``."""

    def __init__(self, client: LanguageClient, folder: Path) -> None:
        self.client = client
        self.folder = folder
        self.versions: dict[str, int] = {}

    def uri(self, name: str) -> str:
        return (self.folder / name).as_uri()

    def put(self, name: str, text: str | bytes) -> None:
        data = text.encode() if isinstance(text, str) else text
        (self.folder / name).write_bytes(data)

    def open(self, name: str, text: str | None = None, language: str = "pddl") -> None:
        """Open a file; without ``text`` as it is on the disk."""
        text = (self.folder / name).read_text() if text is None else text
        self.client.text_document_did_open(
            lsp.DidOpenTextDocumentParams(lsp.TextDocumentItem(self.uri(name), language, 0, text))
        )

    def change(self, name: str, text: str) -> None:
        version = self.versions[name] = self.versions.get(name, 0) + 1
        document = lsp.VersionedTextDocumentIdentifier(version, self.uri(name))
        change = lsp.TextDocumentContentChangeWholeDocument(text)
        self.client.text_document_did_change(lsp.DidChangeTextDocumentParams(document, [change]))

    def close(self, name: str) -> None:
        self.client.text_document_did_close(lsp.DidCloseTextDocumentParams(self.document(name)))

    def document(self, name: str) -> lsp.TextDocumentIdentifier:
        return lsp.TextDocumentIdentifier(self.uri(name))

    async def diagnostics(self, name: str) -> list[lsp.Diagnostic]:
        """The diagnostics that come next."""
        self.client.diagnostics.pop(self.uri(name), None)
        for _ in range(1_000):
            if self.uri(name) in self.client.diagnostics:
                return list(self.client.diagnostics[self.uri(name)])
            await asyncio.sleep(0.01)
        raise TimeoutError(name)

    def at(self, text: str, mark: str, offset: int = 0) -> lsp.Position:
        """The position of a piece of text, in UTF-16."""
        before = text[: text.index(mark) + offset]
        line = before.rpartition("\n")[2]
        return lsp.Position(before.count("\n"), len(line.encode("utf-16-le")) // 2)


@pytest_lsp.fixture(config=SERVER, scope="module")  # type: ignore[untyped-decorator]
async def client(lsp_client: LanguageClient) -> AsyncIterator[None]:
    capabilities = client_capabilities("visual-studio-code")
    await lsp_client.initialize_session(lsp.InitializeParams(capabilities))
    yield
    await lsp_client.shutdown_session()


@pytest_asyncio.fixture(loop_scope="module")
async def editor(client: LanguageClient, tmp_path: Path) -> AsyncIterator[Editor]:
    folder = tmp_path / "domains" / "ferry"
    folder.mkdir(parents=True)
    found = Editor(client, folder)
    found.put("domain.pddl", DOMAIN)
    found.put("one.pddl", PROBLEM)
    yield found
    for uri in list(client.diagnostics):
        client.text_document_did_close(lsp.DidCloseTextDocumentParams(lsp.TextDocumentIdentifier(uri)))
    assert [m.message for m in client.messages if "internal error" in m.message] == []


async def test_diagnostics_are_those_of_the_checker_while_typing(editor: Editor) -> None:
    editor.open("domain.pddl")
    assert await editor.diagnostics("domain.pddl") == []
    for old, new in (("(aboard ?c ?b) (not", "(abord ?c ?b) (not"), ("- boat ?p", "- boot ?p"), ("sail\n", "sail)\n")):
        text = DOMAIN.replace(old, new)
        editor.change("domain.pddl", text)
        found = await editor.diagnostics("domain.pddl")
        editor.put("domain.pddl", text)
        told = check_paths([editor.folder / "domain.pddl"]).diagnostics
        assert told
        assert [(d.code, d.message, d.range.start.line, d.range.start.character) for d in found] == [
            (
                t.code,
                f"{t.message}\nhint: {t.hint}" if t.hint else t.message,
                t.location.line - 1,
                t.location.column - 1,
            )
            for t in told
        ]


async def test_a_problem_is_checked_against_the_unsaved_domain(editor: Editor) -> None:
    editor.open("domain.pddl")
    editor.open("one.pddl")
    assert await editor.diagnostics("one.pddl") == []
    editor.change("domain.pddl", DOMAIN.replace("harbour - port", "home - port"))
    assert [d.code for d in await editor.diagnostics("one.pddl")] == ["unknown-object"]
    editor.close("domain.pddl")
    assert await editor.diagnostics("one.pddl") == []


async def test_hover_tells_who_reads_and_writes_a_predicate(editor: Editor) -> None:
    editor.open("domain.pddl")
    place = editor.at(DOMAIN, "(aboard ?c ?b) (not", 3)
    found = await editor.client.text_document_hover_async(lsp.HoverParams(editor.document("domain.pddl"), place))
    assert found is not None and isinstance(found.contents, lsp.MarkupContent)
    lines = found.contents.value.split("\n")
    assert "(aboard ?c - car ?b - boat)  ; the car is on the boat" in lines
    assert {"read by: action debark", "made true by: action embark", "made false by: action debark"} <= {*lines}


async def test_names_lead_from_a_problem_to_the_domain_and_back(editor: Editor) -> None:
    editor.put("lexicon.yaml", LEXICON)
    editor.open("one.pddl")
    document, place = editor.document("one.pddl"), editor.at(PROBLEM, "(moored", 2)
    declared = await editor.client.text_document_definition_async(lsp.DefinitionParams(document, place))
    at = editor.at(DOMAIN, "(moored", 1)
    span = lsp.Range(at, lsp.Position(at.line, at.character + len("moored")))
    assert declared == [lsp.Location(editor.uri("domain.pddl"), span)]
    context = lsp.ReferenceContext(include_declaration=False)
    used = await editor.client.text_document_references_async(lsp.ReferenceParams(context, document, place))
    assert used is not None
    counts = {
        name: sum(u.uri == editor.uri(name) for u in used) for name in ("domain.pddl", "one.pddl", "lexicon.yaml")
    }
    assert counts == {"domain.pddl": 6, "one.pddl": 1, "lexicon.yaml": 1}


async def renamed(editor: Editor, name: str, text: str, mark: str, new: str) -> dict[str, str]:
    """The texts of the files that a rename changes."""
    place = editor.at(text, mark, 1)
    edit = await editor.client.text_document_rename_async(lsp.RenameParams(editor.document(name), place, new))
    assert edit is not None and edit.changes is not None
    return {Path(uri).name: applied(edits, Path(uri[7:]).read_text()) for uri, edits in edit.changes.items()}


def applied(edits: Sequence[lsp.TextEdit], text: str) -> str:
    """A text after edits, as an editor makes them."""
    lines = text.split("\n")
    for edit in sorted(edits, key=lambda e: (e.range.start.line, e.range.start.character), reverse=True):
        start, end = edit.range.start, edit.range.end
        first, last = lines[start.line].encode("utf-16-le"), lines[end.line].encode("utf-16-le")
        whole = first[: 2 * start.character].decode("utf-16-le") + edit.new_text
        lines[start.line : end.line + 1] = [whole + last[2 * end.character :].decode("utf-16-le")]
    return "\n".join(lines)


async def test_a_rename_changes_every_file_of_the_domain_and_nothing_else(editor: Editor) -> None:
    editor.put("lexicon.yaml", LEXICON)
    editor.open("domain.pddl")
    texts = await renamed(editor, "domain.pddl", DOMAIN, "moored ?b - boat", "tied_up")
    assert texts == {
        "domain.pddl": DOMAIN.replace("moored", "tied_up"),
        "one.pddl": PROBLEM.replace("moored", "tied_up"),
        "lexicon.yaml": LEXICON.replace("moored", "tied_up"),
    }
    texts = await renamed(editor, "domain.pddl", DOMAIN, "?from ?to", "start")
    assert texts == {"domain.pddl": DOMAIN.replace("?from", "?start")}


@pytest.mark.parametrize(
    ("mark", "new", "reason"),
    [
        ("moored ?b - boat", "aboard", "there is a predicate 'aboard' already"),
        ("moored ?b - boat", "two words", "is not a name"),
        ("moored ?b - boat", "and", "is not a name"),
        ("?from ?to", "?b", "there is a variable '?b' already"),
        (":parameters", "x", "no name here"),
    ],
)
async def test_a_rename_that_would_break_something_is_refused(editor: Editor, mark: str, new: str, reason: str) -> None:
    editor.open("domain.pddl")
    with pytest.raises(JsonRpcException, match=re.escape(reason)):
        await renamed(editor, "domain.pddl", DOMAIN, mark, new)


@pytest.mark.parametrize(
    ("before", "wanted", "unwanted"),
    [
        ("(aboard ?c - ", {"car", "boat", "port", "object"}, {"parked"}),
        (":precondition (and (", {"parked", "moored", "not", "exists"}, {"car", "increase"}),
        (":precondition (and (parked ", {"?c", "?b", "?p", "harbour"}, {"?from"}),
        ("(:requirements ", {":typing", ":adl"}, {":goal"}),
        ("(:action embark\n    ", {":parameters", ":effect"}, {":types"}),
        ("(:constants harbour - port) ; ", set(), {"car", "parked"}),
    ],
)
async def test_completion_fits_the_place(editor: Editor, before: str, wanted: set[str], unwanted: set[str]) -> None:
    editor.open("domain.pddl")
    found = await labels(editor, "domain.pddl", DOMAIN, before)
    assert wanted <= found
    assert not unwanted & found


async def labels(editor: Editor, name: str, text: str, before: str) -> set[str]:
    place = editor.at(text, before, len(before))
    found = await editor.client.text_document_completion_async(lsp.CompletionParams(editor.document(name), place))
    assert isinstance(found, list)
    return {item.label for item in found}


async def test_completion_knows_the_keys_of_yaml_files(editor: Editor) -> None:
    editor.open("lexicon.yaml", "nouns:\n  boat: [tug\n\n", "yaml")
    assert {"nouns", "goals"} <= await labels(editor, "lexicon.yaml", "nouns:\n\n", "nouns:\n")
    assert "harbour" in await labels(editor, "lexicon.yaml", "nouns:\n  boat: [tug\n", "boat: [")
    editor.open("objects.yaml", "classes:\n  lorry:\n    \n", "yaml")
    assert {"parent", "parts", "facts"} <= await labels(editor, "objects.yaml", "classes:\n  lorry:\n    \n", "    ")


async def test_a_document_is_formatted_as_by_fmt(editor: Editor) -> None:
    untidy = DOMAIN.replace("\n    :effect", "\n         :effect").replace("\n", "\r\n")
    editor.put("domain.pddl", untidy)
    editor.open("domain.pddl", untidy)
    options = lsp.FormattingOptions(tab_size=2, insert_spaces=True)
    params = lsp.DocumentFormattingParams(editor.document("domain.pddl"), options)
    edits = await editor.client.text_document_formatting_async(params)
    assert edits is not None
    assert applied(edits, untidy.replace("\r\n", "\n")) == format_pddl(untidy)
    editor.change("domain.pddl", "(define (domain ferry")
    with pytest.raises(JsonRpcException, match=r"domain\.pddl:1:"):
        await editor.client.text_document_formatting_async(params)


async def test_quick_fixes_are_those_of_check(editor: Editor) -> None:
    text = DOMAIN.replace(" :negative-preconditions", "").replace("(?c - car ?b - boat", "(?c - car ?b -boat", 1)
    editor.put("domain.pddl", text)
    editor.open("domain.pddl")
    found = await editor.diagnostics("domain.pddl")
    assert found
    everything = lsp.Range(lsp.Position(0, 0), lsp.Position(99, 0))
    context = lsp.CodeActionContext([])
    params = lsp.CodeActionParams(editor.document("domain.pddl"), everything, context)
    actions = await editor.client.text_document_code_action_async(params)
    assert actions
    last = actions[-1]
    assert isinstance(last, lsp.CodeAction) and last.edit is not None and last.edit.changes is not None
    editor.put("fixed.pddl", applied(last.edit.changes[editor.uri("domain.pddl")], text))
    check_paths([editor.folder / "domain.pddl"], fix=True)
    assert (editor.folder / "fixed.pddl").read_text() == (editor.folder / "domain.pddl").read_text()


async def test_a_request_is_tried_from_the_file(editor: Editor) -> None:
    text = f"; try: Take the red car to the harbour.\n{PROBLEM}"
    editor.put("one.pddl", text)
    editor.open("one.pddl")
    lenses = await editor.client.text_document_code_lens_async(lsp.CodeLensParams(editor.document("one.pddl")))
    assert lenses is not None
    commands = {lens.range.start.line: lens.command for lens in lenses}
    command, empty = commands[0], commands[1]
    assert command is not None and empty is not None
    assert empty.title == "try a request here"
    params = lsp.ExecuteCommandParams(command.command, arguments=command.arguments)
    answer = await editor.client.workspace_execute_command_async(params)
    assert "embark(red_car, tug, island)" in str(answer)
    params = lsp.ExecuteCommandParams(empty.command, arguments=empty.arguments)
    assert "; try:" in str(await editor.client.workspace_execute_command_async(params))


async def test_columns_are_those_of_the_editor(editor: Editor) -> None:
    text = DOMAIN.replace("(:types car", "(:types \U0001f6a2 car")  # a ship before what is asked for
    editor.put("domain.pddl", text)
    editor.open("domain.pddl")
    document = editor.document("domain.pddl")
    place = editor.at(text, "car boat port)", 1)
    found = await editor.client.text_document_hover_async(lsp.HoverParams(document, place))
    assert found is not None and found.range is not None
    assert found.range.start == editor.at(text, "car boat port)")


@pytest.mark.parametrize(
    "text",
    [
        "",
        "(((((",
        ")" * 50,
        "(define (domain x) (:types a - (either b) (:predicates (p ?x",
        "(" * 3_000,
        "\ufeff(define (domain x))",
        "(define (domain x)\r\n (:types a\r- b)\u2028)",
        "\x00\x07(define",
        "lone \ud800 surrogate",
        "(define (problem p) (:domain nowhere) (:goal (and)))",
    ],
)
async def test_the_server_answers_whatever_a_file_holds(editor: Editor, text: str) -> None:
    editor.open("domain.pddl", text)
    await everything_asked(editor, "domain.pddl", lsp.Position(0, 3))
    await everything_asked(editor, "domain.pddl", lsp.Position(9_999, 9_999))


async def everything_asked(editor: Editor, name: str, place: lsp.Position) -> None:
    """Ask all there is at a place; an error is one line, and no fault of tmd."""
    client, document = editor.client, editor.document(name)
    span = lsp.Range(lsp.Position(0, 0), place)
    options = lsp.FormattingOptions(tab_size=2, insert_spaces=True)
    asked = [
        client.text_document_hover_async(lsp.HoverParams(document, place)),
        client.text_document_definition_async(lsp.DefinitionParams(document, place)),
        client.text_document_references_async(lsp.ReferenceParams(lsp.ReferenceContext(True), document, place)),
        client.text_document_rename_async(lsp.RenameParams(document, place, "other")),
        client.text_document_completion_async(lsp.CompletionParams(document, place)),
        client.text_document_formatting_async(lsp.DocumentFormattingParams(document, options)),
        client.text_document_code_action_async(lsp.CodeActionParams(document, span, lsp.CodeActionContext([]))),
        client.text_document_code_lens_async(lsp.CodeLensParams(document)),
    ]
    for answer in await asyncio.gather(*asked, return_exceptions=True):
        if isinstance(answer, BaseException):
            assert isinstance(answer, JsonRpcException), answer
            assert "internal error" not in answer.message
            assert "\n" not in answer.message


async def test_files_that_no_domain_owns_are_left_alone(editor: Editor) -> None:
    editor.open("compose.yaml", "services:\n  web: {image: x}\n", "yaml")
    editor.open("lexicon.yaml", "goals: 7\n", "yaml")
    assert await editor.diagnostics("lexicon.yaml")
    assert editor.uri("compose.yaml") not in editor.client.diagnostics
    await everything_asked(editor, "compose.yaml", lsp.Position(0, 2))


async def test_a_document_that_was_never_saved_is_checked(editor: Editor) -> None:
    uri = "untitled:Untitled-1"
    document = lsp.TextDocumentItem(uri, "pddl", 0, "(define (domain d) (:types a - b) (:predicates (p ?x - c)))")
    editor.client.text_document_did_open(lsp.DidOpenTextDocumentParams(document))
    for _ in range(500):
        if editor.client.diagnostics.get(uri):
            break
        await asyncio.sleep(0.01)
    assert "unknown-type" in [diagnostic.code for diagnostic in editor.client.diagnostics[uri]]


@pytest.mark.parametrize("arguments", [[], [""], ["nonsense:", "Take it.", "nowhere.yaml"], [7, None, {}, []]])
async def test_a_request_with_other_arguments_is_answered_in_words(editor: Editor, arguments: list[object]) -> None:
    params = lsp.ExecuteCommandParams("tmd.request", arguments=arguments)
    answer = str(await editor.client.workspace_execute_command_async(params))
    assert answer and "internal error" not in answer and "Traceback" not in answer


async def test_a_file_of_another_encoding_gets_the_diagnostic_of_the_checker(editor: Editor) -> None:
    editor.put("domain.pddl", DOMAIN.replace("home port", "h\xf6me").encode("latin-1"))
    editor.open("domain.pddl", DOMAIN.replace("home port", "h\xf6me"))
    told = check_paths([editor.folder / "domain.pddl"]).diagnostics
    assert [d.code for d in await editor.diagnostics("domain.pddl")] == [t.code for t in told]


async def test_a_folder_may_vanish(editor: Editor) -> None:
    editor.open("one.pddl")
    assert await editor.diagnostics("one.pddl") == []
    for name in ("domain.pddl", "one.pddl"):
        (editor.folder / name).unlink()
    editor.folder.rmdir()
    event = lsp.FileEvent(editor.uri("domain.pddl"), lsp.FileChangeType.Deleted)
    editor.client.workspace_did_change_watched_files(lsp.DidChangeWatchedFilesParams([event]))
    editor.change("one.pddl", PROBLEM)
    assert [d.code for d in await editor.diagnostics("one.pddl")] == ["domain-not-found"]
    await everything_asked(editor, "one.pddl", editor.at(PROBLEM, "(moored", 2))


async def test_random_edits_never_end_the_server(editor: Editor) -> None:
    """``TMD_EDITS`` says how many; 1,000 take a few minutes."""
    chance = random.Random(43)
    files = {"domain.pddl": DOMAIN, "one.pddl": PROBLEM, "lexicon.yaml": LEXICON}
    for name, text in files.items():
        editor.open(name, text)
    pieces = ["(", ")", "?", "-", ":", " ", "\n", "\r\n", ";", "and", ":action", "\U0001f6a2", "\t", "\u00e4", "{", "'"]
    for _ in range(int(os.environ.get("TMD_EDITS", "20"))):
        name = chance.choice([*files])
        text = files[name]
        begin = chance.randrange(len(text) + 1)
        end = min(len(text), begin + chance.choice([0, 0, 1, 5, 60]))
        files[name] = (text[:begin] + chance.choice(pieces) + text[end:]) if chance.random() > 0.05 else DOMAIN
        editor.change(name, files[name])
        row = chance.randrange(files[name].count("\n") + 1)
        await everything_asked(editor, name, lsp.Position(row, chance.randrange(30)))
    editor.change("domain.pddl", DOMAIN)
    await editor.diagnostics("domain.pddl")


async def test_the_server_ends_in_silence_when_the_editor_goes() -> None:
    client: dict[str, object] = {"capabilities": {}, "processId": None, "rootUri": None}
    messages: list[dict[str, object]] = [{"id": 1, "method": "initialize", "params": client}]
    messages += [{"id": 2, "method": "shutdown"}, {"method": "exit"}]
    bodies = [json.dumps({"jsonrpc": "2.0", **message}).encode() for message in messages]
    spoken = b"".join(b"Content-Length: %d\r\n\r\n%s" % (len(body), body) for body in bodies)
    command = SERVER.server_command
    ended = subprocess.run(command, input=spoken, env=SERVER.server_env, capture_output=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, b"")
    assert b'"hoverProvider"' in ended.stdout
