# SPDX-License-Identifier: Apache-2.0
# Goal: tags in the notation of other tools name the same ids in the same role, and similar texts name none.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_trace.base.finding import Place
from mamori_trace.readers.cpp_tags import read_cpp_tags
from mamori_trace.readers.tag_text import ANY_ID, IMPLEMENTS, NAMES, VERIFIES, find_words, make_tags

OFT = r"[a-z]+~[\w.-]+~\d+"


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("// @satisfies SWR-ABC-001, SWR-ABC-002", [("SWR-ABC-001", IMPLEMENTS), ("SWR-ABC-002", IMPLEMENTS)]),
        ("// @verifies SWR-ABC-001", [("SWR-ABC-001", VERIFIES)]),
        ("/// @relation(SWR-ABC-001, SWR-ABC-002, scope=function)", [("SWR-ABC-001", NAMES), ("SWR-ABC-002", NAMES)]),
        ("/// @relation(SWR-ABC-001, scope=file, role=Verifies)", [("SWR-ABC-001", VERIFIES)]),
        ("/// @relation(SWR-ABC-001, role=Implementation)", [("SWR-ABC-001", IMPLEMENTS)]),
        ("// @relation(SWR-ABC-001, scope=range_end)", []),
        ("// [impl->SWR-ABC-001]", [("SWR-ABC-001", IMPLEMENTS)]),
        ("// [impl~watch~2->SWR-ABC-001>>utest,itest] [utest->SWR-ABC-002]", [("SWR-ABC-001", IMPLEMENTS), ("SWR-ABC-002", VERIFIES)]),
        ("// req-Id: SWR-ABC-001", [("SWR-ABC-001", NAMES)]),
        ("// lobster-trace: SWR-ABC-001,SWR-ABC-002", [("SWR-ABC-001", NAMES), ("SWR-ABC-002", NAMES)]),
        ("// @satisfies: SWR-ABC-001", [("SWR-ABC-001", IMPLEMENTS)]),
        ("// @need-ids: SWR-ABC-001", [("SWR-ABC-001", NAMES)]),
        ("// REQ-ID : SWR-ABC-001", [("SWR-ABC-001", NAMES)]),
        ("auto f = [impl]() -> int { return table[i->SWR]; };", []),
        ("// @relation(see below)", []),
    ],
)
@pytest.mark.verifies("SWR-TRC-040", technique="equivalence_classes", polarity="nominal")
def test_each_tool_s_words_name_ids_and_role(line: str, words: list[tuple[str, str]]) -> None:
    assert [(word.requirement, word.role) for word in find_words(line)] == words


@pytest.mark.verifies("SWR-TRC-040", technique="interface", polarity="nominal")
def test_ids_may_have_the_shape_of_another_tool() -> None:
    problems: list = []

    tags = make_tags("// [impl->req~watch.silent~1, req~x~1] [impl->req~watch-late~2]", Place("a.hpp", 3), "watch", problems, OFT)

    assert [(tag.requirement, tag.symbol) for tag in tags] == [("req~watch-late~2", "watch")]
    assert [tag.requirement for tag in make_tags("// lobster-trace: watch.silent", Place("a.hpp", 3), "watch", problems, r"\w+\.\w+")] == ["watch.silent"]
    assert problems == []


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("// [itest->req~watch.silent~1, req~x~1]", [("req~watch.silent~1", VERIFIES), ("req~x~1", VERIFIES)]),
        ("// [Impl~~2->req~x~1>>utest]", [("req~x~1", IMPLEMENTS)]),
        ("// lobster-trace: watch.silent,b/c", [("watch.silent", NAMES), ("b/c", NAMES)]),
        ("// @relation(arm-1, scope=function)", [("arm-1", NAMES)]),
        ("auto next = table[here->next];  // [x -> y]", []),
    ],
)
@pytest.mark.verifies("SWR-TRC-047", technique="equivalence_classes", polarity="nominal")
def test_ids_of_any_shape_are_read_and_code_is_not(line: str, words: list[tuple[str, str]]) -> None:
    assert [(word.requirement, word.role) for word in find_words(line, ANY_ID)] == words


@pytest.mark.verifies("SWR-TRC-040", technique="requirements_based", polarity="nominal")
def test_tags_of_other_tools_are_bound_like_own_ones(tmp_path: Path) -> None:
    (tmp_path / "a.cpp").write_text(
        "// @relation(SWR-ABC-001, scope=file)\n// @relation(SWR-ABC-002, scope=function)\nvoid watch() {\n"
        "    // [impl->SWR-ABC-003]\n    int count = 0;\n}\n"
    )

    tags = read_cpp_tags(tmp_path, [])

    assert [(tag.requirement, tag.symbol, tag.place.line) for tag in tags] == [
        ("SWR-ABC-001", "file", 1), ("SWR-ABC-002", "watch", 2), ("SWR-ABC-003", "watch", 4),
    ]  # fmt: skip
