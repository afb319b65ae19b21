"""The language server: it answers an editor over standard input and output, with pygls."""

from __future__ import annotations

import asyncio
import logging
import os
import re
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import wraps
from pathlib import Path
from typing import Any, ParamSpec, TypeAlias, TypeVar

from lsprotocol import types as lsp
from pygls.capabilities import get_capability
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer
from pygls.uris import from_fs_path, to_fs_path

import tmd
from tmd.check.checker import Checker
from tmd.check.diagnostic import Diagnostic, Severity
from tmd.check.report import fix_file
from tmd.diagnostics import Location, TmdError
from tmd.editor.completion import complete
from tmd.editor.names import NameKind, Occurrence, Role
from tmd.editor.project import Project, lines_of
from tmd.files import UNSAVED, real
from tmd.format.pddl_layout import format_pddl
from tmd.pddl.reading.syntax import TOKEN
from tmd.world.roots import Roots

P = ParamSpec("P")
R = TypeVar("R")
_Opened: TypeAlias = lsp.DidOpenTextDocumentParams | lsp.DidSaveTextDocumentParams
REQUEST = "tmd.request"
"""The command of the code lens: the URI of a file, and perhaps a request and an environment."""
# Seconds without a change before a file is checked, and before the other open files are.
_PAUSE, _LONG_PAUSE = 0.02, 0.5
# A comment that holds a request, perhaps with the environment that it is for.
_TRY = re.compile(r"^\s*[;#]+\s*try(?:\s+([\w./-]+))?:\s*(\S.*?)\s*$", re.IGNORECASE)
_PACKAGE = Path(tmd.__file__).parents[1]
_ITEMS = {
    "type": lsp.CompletionItemKind.Class,
    "predicate": lsp.CompletionItemKind.Property,
    "function": lsp.CompletionItemKind.Value,
    "object": lsp.CompletionItemKind.Constant,
    "action": lsp.CompletionItemKind.Function,
    "variable": lsp.CompletionItemKind.Variable,
}


def _answering(answer: Callable[P, R]) -> Callable[P, R]:
    """Turn what goes wrong in an answer into an error of one line for the editor."""

    @wraps(answer)
    def guarded(*arguments: P.args, **named: P.kwargs) -> R:
        try:
            return answer(*arguments, **named)
        except JsonRpcException:
            raise
        except Exception as error:  # a fault of tmd must not end the server
            raise JsonRpcException(" ".join(_message(error).split()), lsp.LSPErrorCodes.RequestFailed) from None

    return guarded


def _message(error: Exception) -> str:
    """Return the message of an error that is not a fault of tmd, or else one that says that it is."""
    expected = isinstance(error, TmdError | OSError | RecursionError)
    return (str(error) or type(error).__name__) if expected else _internal(error)


def _internal(error: Exception) -> str:
    return f"internal error: {type(error).__name__}: {error}; please report"


def _is_on_disk(file: Path, text: str) -> bool:
    try:
        return file.read_bytes().decode("utf-8-sig") == text
    except OSError:
        return False
    except UnicodeDecodeError:
        return True  # the editor guessed another encoding, which the checker has something to say about


class DomainServer(LanguageServer):
    """Server of one editor: its open files, and their diagnostics."""

    def __init__(self, roots: Roots) -> None:
        super().__init__("tmd", tmd.__version__, text_document_sync_kind=lsp.TextDocumentSyncKind.Full)
        self.project = Project(roots)
        self.found: dict[Path, Sequence[Diagnostic]] = {}
        self.worker = ThreadPoolExecutor(1)
        self._uris: dict[Path, str] = {}
        self._checked_texts: dict[Path, str] = {}
        self._checking: asyncio.Task[None] | None = None
        self._request: asyncio.subprocess.Process | None = None

    # ---------------------------------------------------------------- files and places

    def file(self, uri: str) -> Path:
        """Return the file of a document; one that was never saved counts as one in the current directory."""
        path = Path(to_fs_path(uri) or "untitled") if uri.startswith("file:") else Path(uri.rpartition(":")[2])
        language = self.workspace.get_text_document(uri).language_id if not path.suffix else ""
        return real(path.with_suffix(".pddl") if language == "pddl" else path)

    def uri(self, file: Path) -> str:
        """Return the URI by which the editor knows a file."""
        return self._uris.get(file) or from_fs_path(str(file)) or ""

    def _range(self, lines: Sequence[str], begin: tuple[int, int], end: tuple[int, int]) -> lsp.Range:
        """Return a range in the units of the editor, from rows and columns counted from 0 in characters."""
        characters = lsp.Range(lsp.Position(*begin), lsp.Position(*end))
        return self.workspace.position_codec.range_to_client_units(lines, characters)

    def place(self, uri: str, at: lsp.Position) -> tuple[Path, tuple[str, ...], int]:
        """Return the file of a position, its lines up to it, and the column, counted from 1 in characters."""
        file = self.file(uri)
        lines = lines_of(self.project.text(file))
        row, codec = min(at.line, len(lines) - 1), self.workspace.position_codec
        inside = lsp.Position(row, min(at.character, codec.client_num_units(lines[row])))
        column = codec.position_from_client_units(lines, inside).character
        return file, (*lines[:row], lines[row][:column]), column + 1

    def range(self, place: Location, length: int | None = None) -> lsp.Range:
        """Return the range of so many characters at a place, or of the word there."""
        lines = lines_of(self.project.text(Path(place.file)))
        row = min(place.line, len(lines)) - 1
        line, begin = lines[row], min(place.column, len(lines[row]) + 1) - 1
        if length is None:
            word = TOKEN.match(line, begin)
            length = word.end() - begin if word else 1
        return self._range(lines, (row, begin), (row, begin + length))

    def whole(self, text: str) -> lsp.Range:
        """Return the range of a text."""
        lines = lines_of(text)
        return self._range(lines, (0, 0), (len(lines) - 1, len(lines[-1])))

    def names_at(self, params: Any) -> tuple[Path, list[Occurrence]]:  # noqa: ANN401 - all that have a position
        """Return the file and the names at the position of a request."""
        file, lines, column = self.place(params.text_document.uri, params.position)
        return file, self.project.at(file, len(lines), column)

    def location(self, name: Occurrence) -> lsp.Location:
        """Return the place of a name."""
        return lsp.Location(self.uri(Path(name.place.file)), self.range(name.place, len(name.name)))

    def tell(self, message: str, kind: lsp.MessageType = lsp.MessageType.Info) -> None:
        """Show a message."""
        self.window_show_message(lsp.ShowMessageParams(kind, message))

    # ---------------------------------------------------------------- diagnostics

    def keep(self, file: Path, text: str | None) -> None:
        """Read a file as ``text`` from now on, or from the disk, and check it soon."""
        UNSAVED.pop(file, None)
        if text is not None:
            UNSAVED[file] = text.encode("utf-8", errors="replace")
        self.check_soon(file)

    def check_soon(self, file: Path | None) -> None:
        """Check a file after a short pause, and all open files together after a longer one; changes begin it again."""
        if self._checking is not None:
            self._checking.cancel()
        self._checking = asyncio.get_running_loop().create_task(self._check(file))

    async def _check(self, file: Path | None) -> None:
        files = list(self.project.files)
        await asyncio.sleep(_PAUSE)
        if file is not None and file in files and len(files) > 1:
            found = await self._checked([file])
            self._publish({file: found.get(file, [])})
            await asyncio.sleep(_LONG_PAUSE)
        found = await self._checked(files)
        shown = (file for file, diagnostics in self.found.items() if diagnostics)
        self._publish({file: found.get(file, []) for file in (*files, *shown, *found)})

    async def _checked(self, files: Sequence[Path]) -> Mapping[Path, Sequence[Diagnostic]]:
        try:
            return await asyncio.get_running_loop().run_in_executor(self.worker, self.check, files)
        except Exception as error:  # a fault of tmd must not end the server
            self.tell(_internal(error), lsp.MessageType.Error)
            return {}

    def check(self, files: Sequence[Path]) -> Mapping[Path, Sequence[Diagnostic]]:
        """Return the diagnostics of ``tmd check FILE...``, by the file that they are about."""
        roots = self.project.roots
        checker = Checker(roots.domains, None, roots.problems, files)
        for file in files:
            checker.check_file(file)
        checker.finish()
        found: dict[Path, list[Diagnostic]] = {}
        for diagnostic in checker.findings.sorted():
            found.setdefault(real(Path(diagnostic.location.file)), []).append(diagnostic)
        return found

    def _publish(self, found: Mapping[Path, Sequence[Diagnostic]]) -> None:
        for file, diagnostics in found.items():
            self.found[file], self._checked_texts[file] = diagnostics, self.project.text(file)
            shown = [self._diagnostic(diagnostic) for diagnostic in diagnostics]
            self.text_document_publish_diagnostics(lsp.PublishDiagnosticsParams(self.uri(file), shown))

    def _diagnostic(self, found: Diagnostic) -> lsp.Diagnostic:
        error = found.severity is Severity.ERROR
        return lsp.Diagnostic(
            self.range(found.location),
            f"{found.message}\nhint: {found.hint}" if found.hint else found.message,
            severity=lsp.DiagnosticSeverity.Error if error else lsp.DiagnosticSeverity.Warning,
            code=found.code,
            source="tmd",
        )

    # ---------------------------------------------------------------- what editors send and ask

    def taken_in(self, params: _Opened | lsp.DidChangeTextDocumentParams) -> None:
        """Take in a document; one that was opened or saved is as on the disk, unless its text says otherwise."""
        uri = params.text_document.uri
        file, text = self.file(uri), self.workspace.get_text_document(uri).source
        self._uris[file] = uri
        if file in self.project.files or self.project.is_ours(file, text):
            self.project.files[file] = None
            same = isinstance(params, _Opened) and _is_on_disk(file, text)
            self.keep(file, None if same else text)

    def did_close(self, params: lsp.DidCloseTextDocumentParams) -> None:
        """Forget a document."""
        file = self.file(params.text_document.uri)
        self._uris.pop(file, None)
        if file in self.project.files:
            del self.project.files[file]
            self.keep(file, None)

    def files_changed(self, params: lsp.DidChangeWatchedFilesParams) -> None:
        """Check again: files changed on the disk."""
        self.check_soon(None)

    def hover(self, params: lsp.HoverParams) -> lsp.Hover | None:
        """Return what is known of the names at a place."""
        file, names = self.names_at(params)
        texts = [self.project.hover(file, name) for name in names if self.project.definitions(file, name)]
        markdown = lsp.MarkupContent(lsp.MarkupKind.Markdown, "\n\n---\n\n".join(texts))
        return lsp.Hover(markdown, self.location(names[0]).range) if texts else None

    def definition(self, params: lsp.DefinitionParams) -> list[lsp.Location]:
        """Return where the names at a place are declared."""
        file, names = self.names_at(params)
        return [self.location(found) for name in names for found in self.project.definitions(file, name)]

    def references(self, params: lsp.ReferenceParams) -> list[lsp.Location]:
        """Return every place of the names at a place."""
        file, names = self.names_at(params)
        found = (other for name in names for other in self.project.references(file, name))
        wanted = params.context.include_declaration
        return [self.location(other) for other in found if wanted or other.role is not Role.DECLARED]

    def renamed(self, params: lsp.PrepareRenameParams | lsp.RenameParams) -> tuple[Path, Occurrence]:
        """Return the name that is to be renamed.

        Raises:
            TmdError: No declared name is at that place.
        """
        file, names = self.names_at(params)
        declared = [name for name in names if self.project.definitions(file, name)]
        if not declared:
            raise TmdError("there is no name here that is declared in this domain")
        return file, declared[0]

    def prepare_rename(self, params: lsp.PrepareRenameParams) -> lsp.Range:
        """Return the range of the name that is to be renamed."""
        return self.location(self.renamed(params)[1]).range

    def rename(self, params: lsp.RenameParams) -> lsp.WorkspaceEdit:
        """Return the edits that rename a name, and name the files in which it has to be changed by hand."""
        file, name = self.renamed(params)
        new = f"?{params.new_name.removeprefix('?')}" if name.kind is NameKind.VARIABLE else params.new_name
        changes: dict[str, list[lsp.TextEdit]] = {}
        for place in dict.fromkeys(self.project.rename(file, name, new)):
            found = self.location(place)
            changes.setdefault(found.uri, []).append(lsp.TextEdit(found.range, new))
        left = ", ".join(path.name for path in self.project.unchanged(file, name)[:5])
        if left:
            self.tell(f"'{name.name}' also stands in {left}: change it there by hand", lsp.MessageType.Warning)
        return lsp.WorkspaceEdit(changes=changes)

    def completion(self, params: lsp.CompletionParams) -> list[lsp.CompletionItem]:
        """Return the words that fit at a place."""
        file, lines, column = self.place(params.text_document.uri, params.position)
        word = re.search(r"[^\s()\[\]{},]*$", lines[-1])
        length = len(word[0]) if word else 0
        replaced = self.range(Location(str(file), len(lines), column - length), length)
        return [
            lsp.CompletionItem(
                label, kind=_ITEMS.get(what, lsp.CompletionItemKind.Keyword), detail=what,
                text_edit=lsp.TextEdit(replaced, label),
            )
            for label, what in complete(self.project, file, "\n".join(lines)).items()
        ]  # fmt: skip

    def formatting(self, params: lsp.DocumentFormattingParams) -> list[lsp.TextEdit]:
        """Return what `tmd fmt` makes of a document."""
        file = self.file(params.text_document.uri)
        text = self.project.text(file)
        new = format_pddl(text, str(file)) if file.suffix == ".pddl" else text
        return [lsp.TextEdit(self.whole(text), new)] if new != text else []

    def code_action(self, params: lsp.CodeActionParams) -> list[lsp.CodeAction]:
        """Return the fixes of ``tmd check --fix`` for a range, one by one, and for the whole file."""
        file = self.file(params.text_document.uri)
        text = self.project.text(file)
        # after a change the places of the diagnostics are wrong, until the next ones
        texts = self._fixed(file, params.range) if self._checked_texts.get(file) == text else {}
        whole, uri = self.whole(text), self.uri(file)
        edits = {title: lsp.WorkspaceEdit({uri: [lsp.TextEdit(whole, new)]}) for title, new in texts.items() if new}
        return [lsp.CodeAction(title, lsp.CodeActionKind.QuickFix, edit=edit) for title, edit in edits.items()]

    def _fixed(self, file: Path, chosen: lsp.Range) -> dict[str, str | None]:
        """Return the text after each fix for a range, by what the fix does."""
        known = self.found.get(file, [])
        places = ((found, self.range(found.location)) for found in known)
        within = [found for found, place in places if chosen.start <= place.end and place.start <= chosen.end]
        texts = {f"Fix: {found.hint or found.message}": fix_file(file, [found]) for found in within}
        if any(texts.values()):
            texts["Fix all that is mechanical in this file"] = fix_file(file, known)
        return texts

    def code_lens(self, params: lsp.CodeLensParams) -> list[lsp.CodeLens]:
        """Return a lens on the first line that is no comment, and one on each comment ``try: REQUEST``."""
        uri = params.text_document.uri
        file = self.file(uri)
        if self.project.domain_of(file) is None:
            return []
        lines = lines_of(self.project.text(file))
        top = next((row for row, line in enumerate(lines) if line.strip() and line.lstrip()[0] not in ";#"), 0)
        asked = [(row, found) for row, line in enumerate(lines) if (found := _TRY.match(line))]
        tried = ((row, f"try: {found[2]}", [found[2], *filter(None, [found[1]])]) for row, found in asked)
        return [
            lsp.CodeLens(self._range(lines, (row, 0), (row, 0)), lsp.Command(title, REQUEST, arguments=[uri, *words]))
            for row, title, words in ((top, "try a request here", []), *tried)
        ]

    async def request(self, uri: str = "", text: str = "", environment: str = "") -> str:
        """Show what ``tmd ground`` answers to a request in the domain of a file."""
        try:
            answer = await self._grounded(self.file(str(uri)), str(text), str(environment))
        except Exception as error:  # a fault of tmd must not end the server
            message = _message(error)
            self.tell(message)
            return message
        if get_capability(self.client_capabilities, "window.show_document.support"):
            shown = Path(tempfile.mkdtemp(prefix="tmd-")) / "answer.txt"
            shown.write_text(answer, encoding="utf-8")
            self.window_show_document(lsp.ShowDocumentParams(shown.as_uri(), take_focus=False), lambda _: None)
        else:
            self.tell(answer)
        return answer

    async def _grounded(self, file: Path, text: str, environment: str) -> str:
        """Run ``tmd ground`` in a process of its own, which may take long; one that still runs is stopped."""
        if not text.strip():
            raise TmdError("write the request as a comment, `; try: Take the cup.` (in YAML after #), and try that")
        domain, chosen = self._where(file, environment)
        known = (("--domains", self.project.roots.domains), ("--problems", self.project.roots.problems))
        options = [word for name, root in known if root for word in (name, str(real(root)))]
        self.stop_request()
        self._request = await asyncio.create_subprocess_exec(
            *(sys.executable, "-P", "-m", "tmd", *options, "ground"),
            *("--environment", chosen, "--domain", str(domain.parent), "--text", text),
            env={**os.environ, "PYTHONPATH": os.pathsep.join([str(_PACKAGE), os.environ.get("PYTHONPATH", "")])},
            cwd=domain.parent,
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.STDOUT,
        )
        output, _ = await self._request.communicate()
        unsaved = [path for path in self.project.related(file) if path in UNSAVED]
        notes = [f"note: {path} is not saved; the file on the disk was used\n" for path in unsaved]
        return f"{text}\n{chosen}\n\n{''.join(notes)}{output.decode('utf-8', errors='replace')}"

    def _where(self, file: Path, environment: str) -> tuple[Path, str]:
        """Return the domain of a file and the environment for its requests."""
        domain = self.project.domain_of(file)
        places = [Path(environment)] if environment else self.project.environments(domain) if domain else []
        if domain is None or not places:
            raise TmdError(f"no environment for {file.name} was found; write a problem beside the domain")
        return domain, str(file if file in places else places[0])

    def stop_request(self) -> None:
        """End the request that still runs."""
        if self._request is not None and self._request.returncode is None:
            self._request.kill()


_FEATURES: Mapping[str, Callable[[DomainServer], Callable[..., object]]] = {
    **dict.fromkeys(
        (lsp.TEXT_DOCUMENT_DID_OPEN, lsp.TEXT_DOCUMENT_DID_SAVE, lsp.TEXT_DOCUMENT_DID_CHANGE),
        lambda server: server.taken_in,
    ),
    lsp.TEXT_DOCUMENT_DID_CLOSE: lambda server: server.did_close,
    lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES: lambda server: server.files_changed,
    lsp.TEXT_DOCUMENT_HOVER: lambda server: server.hover,
    lsp.TEXT_DOCUMENT_DEFINITION: lambda server: server.definition,
    lsp.TEXT_DOCUMENT_REFERENCES: lambda server: server.references,
    lsp.TEXT_DOCUMENT_PREPARE_RENAME: lambda server: server.prepare_rename,
    lsp.TEXT_DOCUMENT_RENAME: lambda server: server.rename,
    lsp.TEXT_DOCUMENT_COMPLETION: lambda server: server.completion,
    lsp.TEXT_DOCUMENT_FORMATTING: lambda server: server.formatting,
    lsp.TEXT_DOCUMENT_CODE_ACTION: lambda server: server.code_action,
    lsp.TEXT_DOCUMENT_CODE_LENS: lambda server: server.code_lens,
}
_OPTIONS = {
    lsp.TEXT_DOCUMENT_RENAME: lsp.RenameOptions(prepare_provider=True),
    lsp.TEXT_DOCUMENT_COMPLETION: lsp.CompletionOptions(trigger_characters=["(", "?", ":", "-", " "]),
    lsp.TEXT_DOCUMENT_CODE_ACTION: lsp.CodeActionOptions([lsp.CodeActionKind.QuickFix]),
}


def make_server(roots: Roots) -> DomainServer:
    """Return a server that has not begun to listen."""
    server = DomainServer(roots)
    for name, method in _FEATURES.items():
        server.feature(name, _OPTIONS.get(name))(_answering(method(server)))

    @server.command(REQUEST)
    async def request(*arguments: str) -> str:
        return await server.request(*arguments[:3])

    return server


def serve(roots: Roots) -> None:
    """Answer the editor until it ends the server or goes away."""
    logging.getLogger("pygls").setLevel(logging.CRITICAL + 1)
    server = make_server(roots)
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # no print of a library may get between the answers
    try:
        server.start_io(sys.stdin.buffer, answers)
    finally:
        server.stop_request()
        server.worker.shutdown(wait=False, cancel_futures=True)
