# SPDX-License-Identifier: Apache-2.0
# Goal: the page on supervision shows the actual compiler message. Method: a test of the compiler expects the same message.
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
def test_message_of_the_page_is_the_one_of_the_compiler() -> None:
    (message,) = find_blocks("text")
    rule, sentence = message.splitlines()

    assert rule.removeprefix("SupervisionIsSound<mamori::safety::SupervisionFault::").removesuffix(">") in (
        TESTS / "supervision_compile_test.cpp"
    ).read_text(encoding="utf-8")
    assert sentence in FAULTS.read_text(encoding="utf-8")
