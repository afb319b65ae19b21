"""A studio in a process of its own, and a real browser before it."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Browser

ROOT = Path(__file__).parents[3]
CHROMIUM = next(
    (path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None
)
FLAGS = [
    "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
    "--disable-gpu-compositing",  # the page is put together sooner without shaders that no card runs
    "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run",
]  # fmt: skip


@dataclass
class Served:
    """A studio that runs."""

    arguments: list[str]
    environ: dict[str, str]
    errors: Path
    process: subprocess.Popen[str] | None = None
    url: str = ""
    said: list[str] = field(default_factory=list)

    def start(self) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tmd", *self.arguments], env=self.environ, text=True, stdout=subprocess.PIPE,
            stderr=self.errors.open("a"), cwd=ROOT,
        )  # fmt: skip
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.said.append(line)
            found = re.search(r"http://\S+", line)
            if found:
                self.url = found.group()
                return
        raise AssertionError(f"the studio did not open: {self.said}")

    def kill(self) -> None:
        assert self.process is not None
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    api: Any = pytest.importorskip("playwright.sync_api", reason="needs playwright")
    if CHROMIUM is None:
        pytest.skip("needs a browser: chromium")
    with api.sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield opened
        opened.close()


@pytest.fixture(scope="session")
def screens() -> Path:
    """Where the pictures of the tests stay."""
    directory = Path(os.environ.get("TMD_SCREENS", ROOT / "runs" / "studio"))
    directory.mkdir(parents=True, exist_ok=True)
    return directory


def serve(directory: Path, domain: str, *more: str, learned: Path | None = None) -> Served:
    """A studio of a domain whose problems are copied, so that they may be written to."""
    shutil.copytree(ROOT / "problems" / domain, directory / "problems" / domain)
    saved = ["--learned", str(directory / "learned")] if learned else []
    if learned:  # a studio that learns again writes there
        shutil.copytree(learned / domain, directory / "learned" / domain)
    environ = {**os.environ, "TMD_STUDIO_STATE": str(directory / "drafts"), "OMP_NUM_THREADS": "1"}
    arguments = ["--problems", str(directory / "problems"), "studio", "--domain", domain, "--port", "0", *saved, *more]
    return Served(arguments, environ, directory / "errors.txt")


@pytest.fixture(scope="module")
def kitchen_studio(learned: Path, browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    served = serve(tmp_path_factory.mktemp("kitchen"), "kitchen", "--environment", "kitchen1", learned=learned)
    served.start()
    yield served
    served.kill()


@pytest.fixture(scope="module")
def table_studio(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    served = serve(tmp_path_factory.mktemp("table"), "02_table")
    served.start()
    yield served
    served.kill()
