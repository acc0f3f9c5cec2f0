# SPDX-License-Identifier: Apache-2.0
# Goal: the page on supervision shows code that compiles and passes, and the words of the compiler. Method: its blocks are looked
# for in a test program, its message among what a test of the compiler expects.
from __future__ import annotations

import re

import pytest

from mamori_tools.host.project import ROOT

PAGE = ROOT / "docs" / "manual" / "supervision.md"
TESTS = ROOT / "safety" / "tests" / "supervision"
FAULTS = ROOT / "safety" / "include" / "mamori" / "safety" / "supervision" / "supervision_fault.hpp"


def find_blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


@pytest.mark.verifies("SWR-SUP-033", technique="interface")
def test_each_code_block_of_the_page_is_in_the_source() -> None:
    source = (TESTS / "manual_page_test.cpp").read_text(encoding="utf-8")
    blocks = find_blocks("cpp")

    assert len(blocks) == 5
    assert [block for block in blocks if block not in source] == []


@pytest.mark.verifies("SWR-SUP-033", technique="interface")
def test_message_of_the_page_is_the_one_of_the_compiler() -> None:
    (message,) = find_blocks("text")
    rule, sentence = message.splitlines()

    assert rule.removeprefix("SupervisionIsSound<mamori::safety::SupervisionFault::").removesuffix(">") in (
        TESTS / "supervision_compile_test.cpp"
    ).read_text(encoding="utf-8")
    assert sentence in FAULTS.read_text(encoding="utf-8")
