# SPDX-License-Identifier: Apache-2.0
"""Feeds an XML file to expat in pieces, so that files of any size fit. Rejects content that could fill the memory.

@satisfies SWR-TRC-009, SWR-TRC-042      Design: docs/design/trace.md#input-errors
"""

from __future__ import annotations

import xml.parsers.expat
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from mamori_trace.base.errors import FormatError
from mamori_trace.base.files import UNREADABLE, note_unreadable
from mamori_trace.base.finding import Place, Problem

CHUNK_BYTES = 1 << 18
DEPTH_MAX = 200
"""Maximum nesting depth, far above that of evidence. The parser keeps each open element in memory."""

TOKEN_BYTES_MAX = 32 << 20
"""Maximum size of one tag or one markup item. The parser keeps it in memory until its end."""

Parser = xml.parsers.expat.XMLParserType
Start = Callable[[str, dict[str, str]], None]
End = Callable[[str], None]


def make_parser(start: Start, end: End, text: Callable[[str], None], doctype: bool = False) -> Parser:
    """A parser with these handlers. @param doctype accepts a plain document type; it is never loaded and may define nothing."""
    parser = xml.parsers.expat.ParserCreate()
    depth = 0

    def open_element(tag: str, attributes: dict[str, str]) -> None:
        nonlocal depth
        depth += 1
        if depth > DEPTH_MAX:
            raise FormatError(f"nests more than {DEPTH_MAX} elements, which no tool writes; refused unread")
        start(tag, attributes)

    def close_element(tag: str) -> None:
        nonlocal depth
        depth -= 1
        end(tag)

    def meet_doctype(_name: str, _system: str | None, _public: str | None, defines: int) -> None:
        if defines or not doctype:
            raise FormatError("holds a document type definition (DTD, entities), which no test writes; refused unread")

    parser.StartElementHandler = open_element
    parser.EndElementHandler = close_element
    parser.CharacterDataHandler = text
    parser.StartDoctypeDeclHandler = meet_doctype
    return parser


def feed_file(parser: Parser, path: Path, shown: str, remedy: str, problems: list[Problem]) -> bool:
    """@return whether the complete file was read; otherwise, one problem is reported, which ends with `remedy`."""
    try:
        if not path.is_file() and path.exists():
            raise OSError("it is no file; put one in its place")
        with path.open("rb") as file:
            return feed(parser, file, shown, remedy, problems)
    except OSError as error:
        note_unreadable(error, shown, problems)
        return False


def feed(parser: Parser, file: BinaryIO, shown: str, remedy: str, problems: list[Problem]) -> bool:
    """Like `feed_file`, for an open file. Raises OSError."""
    try:
        given = 0
        while chunk := file.read(CHUNK_BYTES):
            parser.Parse(chunk, False)
            given += len(chunk)
            if given - parser.CurrentByteIndex > TOKEN_BYTES_MAX:
                raise FormatError(f"holds a tag of more than {TOKEN_BYTES_MAX >> 20} MB, which no tool writes; refused unread")
        parser.Parse(b"", True)
        return True
    except FormatError as error:
        problems.append(Problem(UNREADABLE, Place(shown, parser.CurrentLineNumber), str(error)))
    except xml.parsers.expat.ExpatError as error:
        reason = xml.parsers.expat.ErrorString(error.code)
        problems.append(Problem(UNREADABLE, Place(shown, error.lineno), f"is not whole XML ({reason}); {remedy}"))
    except (ValueError, LookupError) as error:  # an encoding that Python does not support
        problems.append(Problem(UNREADABLE, Place(shown, 1), f"is not whole XML ({error}); {remedy}"))
    return False
