"""XML with the location of every element in its file.

The standard tree builder forgets line numbers, and an error about a data set of 360 points is useless without
one. This is the smallest reader on top of expat that keeps them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from tmd import files
from tmd.diagnostics import DataError, Location


@dataclass(slots=True)
class Element:
    """An XML element.

    Attributes:
        children: Its elements, in file order.
    """

    tag: str
    location: Location
    text: str = ""
    children: list[Element] = field(default_factory=list)

    def all(self, tag: str) -> list[Element]:
        """Return the children of that name."""
        return [child for child in self.children if child.tag == tag]

    def walk(self) -> Iterator[Element]:
        """Yield this element and everything below it, in file order."""
        yield self
        for child in self.children:
            yield from child.walk()

    def need(self, tag: str) -> Element:
        """Return the first child of that name.

        Raises:
            DataError: There is none.
        """
        for child in self.all(tag):
            return child
        raise DataError(
            f"<{self.tag}> has no <{tag}>",
            location=self.location,
            hint="compare the file with the released one",
        )

    def get(self, tag: str) -> str:
        """Return the stripped text of the first child of that name; empty without one."""
        return next((child.text.strip() for child in self.all(tag)), "")


def read_xml(path: Path, root: str) -> Element:
    """Return the tree of an XML file whose outermost element is ``root``.

    Raises:
        DataError: The file is missing, is not well-formed (truncated, say) or has another outermost element.
    """
    try:
        data = files.read_bytes(path)
    except FileNotFoundError:
        raise DataError(
            f"{path} is missing",
            hint="give the directory of VEIL-500: it holds data.xml, Objects.xml and Environments/",
        ) from None
    except OSError as error:
        raise DataError(f"{path} cannot be read: {error.strerror}", hint="check the path and its rights") from None
    parser = expat.ParserCreate()
    parser.buffer_text = True
    stack: list[Element] = []
    top: list[Element] = []

    def start(tag: str, _attributes: dict[str, str]) -> None:
        here = Location(str(path), parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)
        element = Element(tag, here)
        (stack[-1].children if stack else top).append(element)
        stack.append(element)

    def end(_tag: str) -> None:
        stack.pop()

    def characters(text: str) -> None:
        stack[-1].text += text

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.CharacterDataHandler = characters
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise DataError(
            f"not well-formed XML: {expat.ErrorString(error.code)}",
            location=Location(str(path), error.lineno, error.offset + 1),
            hint="the file seems cut off or edited; copy it again from the release",
        ) from None
    if top[0].tag != root:
        raise DataError(
            f"<{root}> expected, <{top[0].tag}> found",
            location=top[0].location,
            hint="is this the right file? copy it again from the release",
        )
    return top[0]
