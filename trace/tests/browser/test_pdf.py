# SPDX-License-Identifier: Apache-2.0
# Goal: a real browser prints the page with page numbers; equal inputs give equal bytes.
from __future__ import annotations

from collections.abc import Callable

import pytest
from trace_sample import Sample


@pytest.mark.verifies("SWR-TRC-065", technique="requirements_based", polarity="nominal")
def test_the_report_is_printed_and_the_same_again(sample: Sample, trace: Callable) -> None:
    files = [sample.root / "first.pdf", sample.root / "second.pdf"]
    for file in files:
        outcome = trace("report", "--root", sample.root, "--pdf", file)
        assert (outcome.status, outcome.err) == (0, "")
        assert f"report: {file}" in outcome.out

    first, second = (file.read_bytes() for file in files)
    assert first.startswith(b"%PDF-")
    assert first.rstrip().endswith(b"%%EOF")
    assert first.count(b"/Type /Page\n") >= 3
    assert first == second
