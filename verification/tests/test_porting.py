# SPDX-License-Identifier: Apache-2.0
# Goal: the page for authors of ports shows code that compiles and passes. Method: its blocks are looked for in a test program.
from __future__ import annotations

import re
import textwrap

import pytest

from mamori_tools.host.project import ROOT

PAGE = ROOT / "docs" / "manual" / "porting.md"
SOURCE = ROOT / "ports" / "conformance" / "tests" / "porting_page_test.cpp"


@pytest.mark.verifies("SWR-CNF-008", technique="interface")
def test_each_code_block_of_the_page_is_in_the_source() -> None:
    source = SOURCE.read_text(encoding="utf-8")
    blocks = re.findall(r"^```cpp\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)

    assert len(blocks) == 2
    assert [block for block in blocks if block not in source and textwrap.indent(block, " " * 4) not in source] == []
