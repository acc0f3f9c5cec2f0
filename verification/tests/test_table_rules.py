# SPDX-License-Identifier: Apache-2.0
# Goal: the page of the rules of a system table is what the kernel states. Method: comparison with the list of the kernel.
from __future__ import annotations

import pytest

from mamori_tools.host.project import ROOT
from verification.checks.table_rules import LIST, PAGE, make_page


@pytest.mark.verifies("SWR-TAB-015", technique="back_to_back")
def test_page_lists_each_rule_with_the_sentence_of_the_kernel() -> None:
    text = (ROOT / LIST).read_text("utf-8")
    page = make_page(text)

    assert page.count("\n| `") == text.count("    X(") > 40
    assert (ROOT / PAGE).read_text("utf-8") == page, "run: .venv/bin/python -P -m verification.checks.table_rules"
