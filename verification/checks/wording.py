# SPDX-License-Identifier: Apache-2.0
"""Limits the use of expressions that readers misunderstand: the list wording.toml has a maximum for each, which may only decrease.

    python -m verification.checks.wording

lowers each maximum to the current number of occurrences. The layer check reports an expression that became more frequent.

@satisfies SWR-PRF-043      Design: docs/design/launcher.md#layer-check
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.text_file import write_text

WORDING = "verification/checks/wording.toml"
FILE = Path(__file__).with_name("wording.toml")
PLACES = ("CONTRIBUTING.md", "README.md", "docs", "examples", "kernel", "mamori", "ports", "requirements", "safety", "simbody_sim", "tools", "trace",
          "verification")  # fmt: skip
SUFFIXES = (".cpp", ".hpp", ".md", ".py", "")
# Decision records stay unchanged, the glossary explains old words, and the list and its tests contain all expressions.
LEFT_OUT = ("docs/adr/", "docs/glossary.md", "verification/checks/wording", "verification/tests/test_wording")
SHOWN = 3  # locations of an expression that became more frequent


@dataclass(frozen=True)
class Expression:
    """Words of the list. `maximum` is the permitted number of occurrences."""

    text: str
    instead: str
    maximum: int


def read_expressions(file: Path = FILE) -> list[Expression]:
    return [Expression(row["text"], row["instead"], row["max"]) for row in tomllib.loads(file.read_text(encoding="utf-8"))["expression"]]


def list_texts(root: Path) -> Iterator[Path]:
    """The files that people read, sorted by path."""
    for place in PLACES:
        top = root / place
        for path in [top] if top.is_file() else sorted(top.rglob("*")):
            name = path.relative_to(root).as_posix()
            is_left_out = name.startswith(LEFT_OUT) or "__pycache__" in name
            if path.is_file() and path.suffix in SUFFIXES and not is_left_out:
                yield path


def find_expressions(root: Path, expressions: list[Expression]) -> dict[str, list[tuple[str, int]]]:
    """@return file and line of each occurrence, by expression. Ignores case and the kind of white space between words."""
    places: dict[str, list[tuple[str, int]]] = {each.text: [] for each in expressions}
    patterns = [(each.text, each.text.split()[0], _make_pattern(each.text)) for each in expressions]
    for path in list_texts(root):
        text = path.read_text(encoding="utf-8", errors="replace").lower()
        name = path.relative_to(root).as_posix()
        for expression, first, pattern in patterns:
            if first in text:
                places[expression] += [(name, text.count("\n", 0, match.start()) + 1) for match in pattern.finditer(text)]
    return places


def _make_pattern(text: str) -> re.Pattern[str]:
    """A line end and a comment sign are permitted between two words."""
    return re.compile(r"\b" + r"\s+(?:(?://[/!<]*|[#*])\s*)?".join(re.escape(word) for word in text.split()) + r"\b")


def check_wording(root: Path, file: Path = FILE) -> Iterator[tuple[str, int, str]]:
    """@return file, line and message for each expression that exceeds its maximum, or whose maximum must be lowered."""
    expressions = read_expressions(file)
    for each, places in zip(expressions, find_expressions(root, expressions).values(), strict=True):
        if len(places) > each.maximum:
            for name, line in places[: SHOWN if each.maximum else None]:
                yield name, line, f"'{each.text}' occurs {len(places)} times, at most {each.maximum} are allowed; write: {each.instead}"
        elif len(places) < each.maximum:
            yield file.name, 1, f"'{each.text}' occurs {len(places)} times; lower its max from {each.maximum}"


def lower(root: Path, file: Path = FILE) -> None:
    """Writes the list and lowers each maximum to the number of occurrences."""
    text = file.read_text(encoding="utf-8")
    expressions = read_expressions(file)
    for each, places in zip(expressions, find_expressions(root, expressions).values(), strict=True):
        if len(places) < each.maximum:
            row = f'text = "{each.text}"\ninstead = "{each.instead}"\nmax = '
            text = text.replace(f"{row}{each.maximum}\n", f"{row}{len(places)}\n")
    write_text(file, text)


if __name__ == "__main__":
    lower(Path(__file__).resolve().parents[2])
