# SPDX-License-Identifier: Apache-2.0
# Goal: the page on redundancy, self tests and assumptions shows code that compiles and runs. Method: its blocks are looked for in a
# test program, in their order, and no code stands outside of them.
from __future__ import annotations

import re

import pytest

from mamori_tools.host.project import ROOT

PAGE = ROOT / "docs" / "manual" / "integrity.md"
SOURCE = ROOT / "safety" / "tests" / "integrity_page_test.cpp"
BLOCK = re.compile(r"^```cpp\n(.*?)^```$", re.DOTALL | re.MULTILINE)


@pytest.mark.verifies("SWR-AOU-010", technique="interface")
def test_each_code_block_of_the_page_is_in_the_source() -> None:
    source = SOURCE.read_text(encoding="utf-8")
    page = PAGE.read_text(encoding="utf-8")
    blocks = BLOCK.findall(page)

    assert len(blocks) == 6
    assert [block for block in blocks if block not in source] == []
    places = [source.find(block) for block in blocks]
    assert places == sorted(places)
    rest = BLOCK.sub("", page)
    assert "```" not in rest
    assert not re.search(r"^ {4}", rest, re.MULTILINE), "code that nothing compiles"
