# SPDX-License-Identifier: Apache-2.0
"""Compares the list of safety headers that the example arm does not use with the headers that its sources include, directly or through others.

@satisfies SWR-PRF-051      Design: docs/design/launcher.md#layer-check
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

PAGE = "docs/manual/headers.md"
HEADING = "## Safety headers that the example arm does not use"
HEADERS = "safety/include"
EXAMPLE = "examples/safe_arm"
LIMIT = 12  # rows

_ROW = re.compile(r"\| `(?P<header>[^`]+\.hpp)` \| (?P<reason>.*\S) \|")
_INCLUDE = re.compile(r'^\s*#\s*include\s*"(?P<path>[^"]+)"', re.MULTILINE)


def find_used(root: Path) -> set[Path]:
    """Files of the project that the sources of the example include, without its tests."""
    folders = [*root.glob("*/include"), *root.glob("ports/*/include"), *root.glob("tools/probe/*/include"), root / EXAMPLE, root / EXAMPLE / "hil"]
    waiting = [path for path in (root / EXAMPLE).rglob("*.[ch]pp") if "tests" not in path.relative_to(root).parts]
    used = set(waiting)
    while waiting:
        path = waiting.pop()
        for include in _INCLUDE.findall(path.read_text(encoding="utf-8")):
            found = next((folder / include for folder in (path.parent, *folders) if (folder / include).is_file()), None)
            if found is not None and found not in used:
                used.add(found)
                waiting.append(found)
    return used


def check_unused(root: Path) -> Iterator[tuple[str, int, str]]:
    """@return file, line and message for each row that is wrong and each header without a row; nothing in a tree without the page."""
    if not (root / PAGE).is_file():
        return
    lines = (root / PAGE).read_text(encoding="utf-8").splitlines()
    heading = lines.index(HEADING) + 1 if HEADING in lines else 1
    headers = {path.relative_to(root / HEADERS).as_posix(): path for path in (root / HEADERS).rglob("*.hpp")}
    used = find_used(root)
    unused = {name for name, path in headers.items() if path not in used}
    listed = set()
    for number, line in enumerate(lines[heading:], heading + 1):
        if line.startswith("## "):
            break
        if (row := _ROW.fullmatch(line)) is None:
            continue
        name = row["header"]
        if name in listed:
            yield PAGE, number, f"two rows for '{name}'; keep one"
        elif name not in unused:
            yield PAGE, number, f"'{name}' is {'used by the example arm' if name in headers else 'not a safety header'}; remove the row"
        listed.add(name)
    if len(listed) > LIMIT:
        yield PAGE, heading, f"{len(listed)} headers that the example arm does not use; the limit is {LIMIT}: use a header in the example, or remove it"
    for name in sorted(unused - listed):
        yield PAGE, heading, f"the example arm does not use '{name}'; add a row with the reason, or remove the header"
