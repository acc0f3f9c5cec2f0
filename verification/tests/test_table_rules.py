# SPDX-License-Identifier: Apache-2.0
# Goal: the page of table rules agrees with the kernel. Method: comparison with the list of the kernel.
from __future__ import annotations

import re

import pytest

from mamori_tools.host.project import ROOT
from verification.checks.table_rules import INCLUDES, LIST, PAGE, make_page


@pytest.mark.verifies("SWR-TAB-015", technique="back_to_back")
def test_page_lists_each_rule_with_the_sentence_of_the_kernel() -> None:
    page = make_page(ROOT)
    rules, _, others = page.partition("## State machines")

    assert rules.count("\n| `") == (ROOT / LIST).read_text("utf-8").count("    X(") > 40
    assert others.count("\n| `k") >= 9 + 6
    assert (ROOT / PAGE).read_text("utf-8") == page, "run: .venv/bin/python -P -m verification.checks.table_rules"


@pytest.mark.verifies("SWR-TAB-015", technique="back_to_back")
def test_page_lists_each_assertion_with_a_sentence() -> None:
    texts = [path.read_text("utf-8") for folder in INCLUDES for path in (ROOT / folder).rglob("*.hpp")]
    page = make_page(ROOT)

    ends = [end for text in texts for end in re.findall(r'^ +static_assert\([^;]*?"([^"\n]*)"[\s\\]*\)', text, re.MULTILINE)]
    assert len(ends) > 100
    assert [end for end in ends if f"{end}\n" not in page] == []
