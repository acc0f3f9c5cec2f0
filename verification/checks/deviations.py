# SPDX-License-Identifier: Apache-2.0
"""Compares docs/deviations.yaml with the code of the layers that run on a controller. Each assembler statement must name its row. Each row
must be complete and named by a line of its file.

@satisfies SWR-SLF-020      Design: docs/design/launcher.md#layer-check
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

import yaml

from verification.checks.target_limits import COMMENT_OR_TEXT

FILE = "docs/deviations.yaml"
FIELDS = ("id", "rule", "file", "function", "reason", "safe_because", "agreed")
IDENTIFIER = re.compile(r"DEV-\d{3}")
NAMED = re.compile(rf"//.*?\b({IDENTIFIER.pattern})\b")
ASSEMBLER = re.compile(r"\b(?:asm|__asm|__asm__)\b")

Row = Mapping[str, str]
Place = tuple[str, int, str, str]  # file, line, rule, message


def check_deviations(root: Path, code: Mapping[str, str]) -> Iterator[Place]:
    """@param code text of each source of the target layers, by its path below `root`. @return errors in rows and code."""
    text = (root / FILE).read_text(encoding="utf-8") if (root / FILE).is_file() else "deviations: []"
    try:
        table = yaml.safe_load(text)
    except yaml.YAMLError as error:
        yield FILE, 1, "deviation", f"no YAML: {' '.join(str(error).split())}; mend it"
        return
    rows = table.get("deviations") if isinstance(table, dict) else None
    if not isinstance(rows, list):
        yield FILE, 1, "deviation", "has no list 'deviations'; add one, empty when there are none"
        return
    whole: dict[str, Row] = {}
    for number, row in enumerate(rows, start=1):
        messages = list(_check_row(root, row, code))
        if not messages and row["id"] in whole:
            messages = [f"{row['id']} stands there twice; an identifier is never reused"]
        yield from ((FILE, 1, "deviation", f"row {number}: {message}") for message in messages)
        if not messages:
            whole[row["id"]] = row
    for file, source in code.items():
        yield from _check_source(file, source, whole)


def _check_row(root: Path, row: object, code: Mapping[str, str]) -> Iterator[str]:
    if not isinstance(row, dict) or set(row) != set(FIELDS) or not all(isinstance(value, str) and value for value in row.values()):
        yield f"needs a text in each of {', '.join(FIELDS)}, and nothing else"
    elif not IDENTIFIER.fullmatch(row["id"]):
        yield f"'{row['id']}' is no identifier; write DEV- and three digits"
    elif row["file"] not in code:
        yield f"'{row['file']}' is no source of a target layer; correct it or remove the row"
    elif not re.search(rf"\b{re.escape(row['function'])}\(", code[row["file"]]):
        yield f"{row['file']} has no function '{row['function']}'; correct it or remove the row"
    elif row["id"] not in NAMED.findall(code[row["file"]]):
        yield f"no line of {row['file']} names {row['id']}; remove the row or name it"
    elif not (root / row["agreed"]).is_file():
        yield f"'{row['agreed']}' is no file; name the decision that agreed to it"


def _check_source(file: str, source: str, rows: Mapping[str, Row]) -> Iterator[Place]:
    code = COMMENT_OR_TEXT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), source)
    for number, (line, bare) in enumerate(zip(source.splitlines(), code.splitlines(), strict=True), start=1):
        names = NAMED.findall(line)
        if ASSEMBLER.search(bare) and not names:
            yield file, number, "deviation", f"assembler statement without a row; add one to {FILE} and its identifier to this line"
        for name in names:
            if name not in rows or rows[name]["file"] != file:
                yield file, number, "deviation", f"{name} is no sound row for this file in {FILE}"
