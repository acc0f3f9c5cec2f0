# SPDX-License-Identifier: Apache-2.0
# Goal: the page on protected ports shows code that compiles and runs. Method: its blocks are looked for in a test program.
from __future__ import annotations

import re

import pytest

from mamori_tools.host.project import ROOT

PAGE = ROOT / "docs" / "manual" / "e2e.md"
SOURCE = ROOT / "verification" / "e2e" / "tests" / "protected_speed.hpp"


@pytest.mark.verifies("SWR-E2E-040", technique="interface")
def test_each_code_block_of_the_page_is_in_the_source() -> None:
    source = SOURCE.read_text(encoding="utf-8")
    blocks = re.findall(r"^```cpp\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)

    assert len(blocks) == 6
    assert [block for block in blocks if block not in source] == []
