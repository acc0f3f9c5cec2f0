# SPDX-License-Identifier: Apache-2.0
"""The arguments that select a project in the format of another tool: `--format FORMAT PATH [--results FILES]`.

@satisfies SWR-TRC-045      Design: docs/design/trace_formats.md#in-place
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from mamori_trace.base.errors import InputError
from mamori_trace.formats.registry import FORMATS

if TYPE_CHECKING:
    from mamori_trace.formats.in_place import ForeignInput


def add_foreign(parser: argparse.ArgumentParser) -> None:
    """The external project to read."""
    words = parser.add_argument_group("a project kept in the format of another tool")
    words.add_argument("--format", nargs=2, metavar=("FORMAT", "PATH"), help=f"FORMAT is {', '.join(FORMATS)}; PATH a file or folder")
    words.add_argument("--results", nargs="+", action="extend", type=Path, metavar="FILE", help="JUnit files, or folders of them")
    words.add_argument("--sources", type=Path, metavar="DIR", help="folder of code and tests (default: the folder of PATH)")
    words.add_argument("--schema", type=Path, metavar="FILE", help="meaning of its values and levels, where the data does not specify it")


def get_foreign(arguments: argparse.Namespace) -> ForeignInput | None:
    """The chosen external project, or None for a project in Mamori's own format. Raises InputError."""
    if not arguments.format:
        for name in ("results", "sources", "schema"):
            if getattr(arguments, name):
                raise InputError(f"--{name} belongs to --format FORMAT PATH, which is missing")
        return None
    name, path = arguments.format
    check_format(name)
    sources = arguments.sources
    if sources is not None and not sources.is_dir():
        raise InputError(f"{sources}: no such folder of sources")
    from mamori_trace.formats.in_place import ForeignInput

    return ForeignInput(name, Path(path), arguments.root, arguments.results or [], sources, arguments.schema, arguments.evidence,
                        arguments.allow_missing, getattr(arguments, "date", None) or "")  # fmt: skip


def check_format(name: str) -> None:
    """Raises InputError for an unknown format name."""
    if name not in FORMATS:
        raise InputError(f"--format {name}: unknown; known are {', '.join(FORMATS)}")
