# SPDX-License-Identifier: Apache-2.0
"""The formats by name, and the detection of the format of a file."""

from __future__ import annotations

import importlib
from itertools import islice
from pathlib import Path
from types import ModuleType

from mamori_trace.base.errors import InputError
from mamori_trace.base.finding import Problem
from mamori_trace.formats.files import list_files
from mamori_trace.formats.model import ForeignProject

FORMATS = {"strictdoc": "sdoc", "needs": "needs", "oft": "oft", "doorstop": "doorstop", "trlc": "trlc", "reqif": "reqif", "csv": "csv_file"}
"""Module of each format, in this package. It is loaded on demand, because most checks need none and loading is slow."""

_PEEK_BYTES = 65536
_PEEK_FILES = 200


def load_format(name: str) -> ModuleType:
    return importlib.import_module(f"mamori_trace.formats.{FORMATS[name]}")


def read_format(name: str, path: Path, root: Path, problems: list[Problem]) -> ForeignProject:
    """All items. Raises InputError if there is nothing to check: path, file of the format, or items are missing."""
    module = load_format(name)
    if not path.exists():
        raise InputError(f"{path}: no such file or folder")
    before = len(problems)
    project = module.read(path, root, problems)
    unread = len(problems) > before
    if not project.items and (not unread or _guess_others(name, path)):
        raise InputError(_describe_nothing(name, module, path))
    return project


def _describe_nothing(name: str, module: ModuleType, path: Path) -> str:
    others = _guess_others(name, path)
    if others:
        return f"{path}: holds no item of {module.TITLE}; it looks like {load_format(others[0]).TITLE}: use --format {others[0]}"
    wanted = " or ".join(f"*{suffix}" if suffix.startswith(".") else suffix for suffix in module.SUFFIXES)
    return f"{path}: holds no item of {module.TITLE} (looked for {wanted}); name the file or folder of the requirements"


def _guess_others(name: str, path: Path) -> list[str]:
    """Other formats that files below `path` resemble, the most frequent first."""
    counts: dict[str, int] = {}
    for file in islice(list_files(path, ("",), path, []), _PEEK_FILES):
        if not file.is_file():  # reading a pipe would never end
            continue
        try:
            with file.open("rb") as stream:
                text = stream.read(_PEEK_BYTES).decode("utf-8-sig", errors="replace")
        except OSError:
            continue
        for other in FORMATS:
            if other != name and load_format(other).looks_alike(file.name, text):
                counts[other] = counts.get(other, 0) + 1
    return sorted(counts, key=lambda other: (-counts[other], other))
