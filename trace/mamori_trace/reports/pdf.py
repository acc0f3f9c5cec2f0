# SPDX-License-Identifier: Apache-2.0
"""Prints a page to a PDF file.

@satisfies SWR-TRC-065      Design: docs/design/trace.md#pdf
"""

from __future__ import annotations

import base64
import re
import tempfile
from pathlib import Path

from mamori_trace.base.write import write_whole_bytes
from mamori_trace.reports.chromium import Chromium

_SECONDS_MAX = 300.0
# Only these bytes would differ in a second run. The replacement has the same length, so that all object offsets stay valid.
_DATES = re.compile(rb"/(CreationDate|ModDate) \(D:\d{14}\+00'00'\)")
_DATE = rb"/\1 (D:20000101000000+00'00')"
_NODES = re.compile(rb"\bnode\d{8}\b")


def print_page(page: str, out: Path) -> None:
    """Writes `out` atomically. Raises WorkError and InputError."""
    with tempfile.TemporaryDirectory(prefix="mamori-paper-") as folder:
        file = Path(folder) / "report.html"
        file.write_text(page, encoding="utf-8", newline="\n")
        with Chromium(_SECONDS_MAX) as browser:
            browser.open(file.as_uri())
            answer = browser.call("Page.printToPDF", {"printBackground": True, "preferCSSPageSize": True, "generateDocumentOutline": True})
    write_whole_bytes(out, fix_bytes(base64.b64decode(answer["data"])))


def fix_bytes(pdf: bytes) -> bytes:
    """`pdf` without its date; its structure marks are numbered from one, in order."""
    numbers = {name: number for number, name in enumerate(sorted(set(_NODES.findall(pdf))), start=1)}
    return _DATES.sub(_DATE, _NODES.sub(lambda match: b"node%08d" % numbers[match[0]], pdf))
