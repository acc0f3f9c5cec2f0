# SPDX-License-Identifier: Apache-2.0
# Goal: a tag is bound to the code that it documents; texts that resemble tags are ignored; tests are found with their suite.
from __future__ import annotations

from pathlib import Path

import pytest
import tree_sitter
import tree_sitter_cpp

from mamori_trace.base.finding import Problem
from mamori_trace.model.evidence import CodeTag
from mamori_trace.readers.cpp_tags import parse_cpp_tags
from mamori_trace.readers.cpp_tests import parse_cpp_tests
from mamori_trace.readers.python_sources import read_python
from mamori_trace.readers.script_tags import read_script_tags

CPP = """// SPDX-License-Identifier: Apache-2.0
/// @file
/// What it is.
///
/// @satisfies SWR-ABC-001, SWR-ABC-002      Design: docs/design/a.md#b
#ifndef A
namespace a {
/// A class.
/// @satisfies SWR-ABC-003
class Watcher final {
  public:
    /** Starts.
     *  @satisfies SWR-ABC-004 */
    [[nodiscard]] Status start(int count) noexcept;

    /// @satisfies SWR-ABC-005
    template <typename T>
    const T& get() const;
};

/// @satisfies SWR-ABC-006
struct Plain {};

/// @satisfies SWR-ABC-007
inline constexpr int kLimit = 3;

const char* text = "@satisfies SWR-ABC-999";
}  // namespace a
#endif
"""


def parse(text: str) -> tuple[list[CodeTag], list[Problem]]:
    problems: list[Problem] = []
    parser = tree_sitter.Parser(tree_sitter.Language(tree_sitter_cpp.language()))
    return parse_cpp_tags(text, "a.hpp", parser, problems), problems


@pytest.mark.verifies("SWR-TRC-002", technique="requirements_based", polarity="nominal")
def test_cpp_tags_are_bound_to_the_declaration_below_or_to_the_file() -> None:
    tags, problems = parse(CPP)

    assert problems == []
    assert [(tag.requirement, tag.place.line, tag.symbol) for tag in tags] == [
        ("SWR-ABC-001", 5, "file"),
        ("SWR-ABC-002", 5, "file"),
        ("SWR-ABC-003", 9, "Watcher"),
        ("SWR-ABC-004", 13, "start"),
        ("SWR-ABC-005", 16, "get"),
        ("SWR-ABC-006", 21, "Plain"),
        ("SWR-ABC-007", 24, "kLimit"),
    ]


@pytest.mark.verifies("SWR-TRC-002", technique="error_guessing", polarity="violation")
def test_a_tag_that_names_nothing_is_told() -> None:
    tags, problems = parse("/// @satisfies\nint a;\n/// @satisfies the standard\nint b;\n")

    assert tags == []
    assert [problem.place.line for problem in problems] == [1, 3]


@pytest.mark.verifies("SWR-TRC-002", technique="requirements_based", polarity="nominal")
def test_python_tags_are_read_from_docstrings_and_comments_only(tmp_path: Path) -> None:
    (tmp_path / "tool.py").write_text(
        '"""Tool.\n\n@satisfies SWR-ABC-001\n"""\n'
        'TEXT = """\n@satisfies SWR-ABC-999\n"""\n\n\n'
        "# @satisfies SWR-ABC-002\n@wrapped\ndef run():\n"
        '    """Runs.\n\n    @satisfies SWR-ABC-003\n    """\n'
    )
    problems: list[Problem] = []

    tags, tests = read_python(tmp_path, problems)

    assert (problems, tests) == ([], [])
    assert [(tag.requirement, tag.place.line, tag.symbol) for tag in tags] == [
        ("SWR-ABC-001", 3, "file"),
        ("SWR-ABC-002", 10, "run"),
        ("SWR-ABC-003", 15, "run"),
    ]


@pytest.mark.verifies("SWR-TRC-002", technique="equivalence_classes", polarity="nominal")
def test_scripts_and_build_files_carry_tags_for_the_whole_file(tmp_path: Path) -> None:
    (tmp_path / "mamori").write_text("#!/usr/bin/env bash\n# @satisfies SWR-ABC-001\necho '@satisfies SWR-ABC-999'\n")
    (tmp_path / "LICENSE").write_text("# @satisfies SWR-ABC-999\n")
    (tmp_path / "cmake").mkdir()
    (tmp_path / "cmake" / "a.cmake").write_text("# @satisfies SWR-ABC-002\n")

    tags = read_script_tags(tmp_path, [])

    assert [(tag.requirement, str(tag.place)) for tag in tags] == [("SWR-ABC-001", "mamori:2"), ("SWR-ABC-002", "cmake/a.cmake:1")]


@pytest.mark.verifies("SWR-TRC-003", technique="requirements_based", polarity="nominal")
def test_calls_of_verifies_are_found_with_their_test() -> None:
    text = (
        "// verifies(\"SWR-ABC-999\");\n"
        "TEST(PlainTest, Works) {\n    verifies(\"SWR-ABC-001\");\n}\n"
        "TEST_P(ParameterTest, Holds) {\n    verifies(\"SWR-ABC-002\", Technique::kBoundaryValues,\n             Polarity::kViolation);\n}\n"
    )

    tests = parse_cpp_tests(text, "a_test.cpp")

    assert [(t.requirement, t.title, t.technique, t.polarity, t.place.line) for t in tests] == [
        ("SWR-ABC-001", "PlainTest.Works", "requirements_based", "nominal", 3),
        ("SWR-ABC-002", "ParameterTest.Holds", "boundary_values", "violation", 6),
    ]


@pytest.mark.verifies("SWR-TRC-003", technique="requirements_based", polarity="nominal")
def test_marks_of_python_tests_are_found_also_on_classes(tmp_path: Path) -> None:
    (tmp_path / "test_a.py").write_text(
        '@pytest.mark.verifies("SWR-ABC-001", polarity="violation")\ndef test_one():\n    pass\n\n\n'
        '@pytest.mark.verifies("SWR-ABC-002")\nclass TestGroup:\n    def test_two(self):\n        pass\n'
    )

    _, tests = read_python(tmp_path, [])

    assert [(t.requirement, t.title, t.polarity, t.place.line) for t in tests] == [
        ("SWR-ABC-001", "test_a.test_one", "violation", 2),
        ("SWR-ABC-002", "test_a.TestGroup.test_two", "nominal", 8),
    ]
