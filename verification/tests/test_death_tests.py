# SPDX-License-Identifier: Apache-2.0
# Goal: exactly the death tests that accept any cause of death are found, with their location. Method: the shipped tree, one seeded call per
# case, and the complete check on a seeded file of each layer.
from __future__ import annotations

from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.checks.check_layers import check_tree
from verification.checks.death_tests import check_death_tests


@pytest.mark.verifies("SWR-VER-024")
def test_shipped_death_tests_state_their_cause() -> None:
    assert [finding for finding in check_tree(ROOT) if finding.rule == "death"] == []


@pytest.mark.parametrize("layer", ["kernel", "safety", "ports/posix_rt", "simbody_sim", "examples/safe_arm", "verification/e2e"])
@pytest.mark.verifies("SWR-VER-024", technique="fault_injection", polarity="violation")
def test_seeded_death_test_without_a_cause_is_found_in_each_layer(tmp_path: Path, layer: str) -> None:
    name = f"{layer}/tests/a_test.cpp"
    (tmp_path / name).parent.mkdir(parents=True)
    (tmp_path / name).write_text('\nEXPECT_DEATH(f(), "");\nEXPECT_DEATH(f(), "^$");\n', encoding="utf-8")

    found = [str(finding) for finding in check_tree(tmp_path)]

    assert len(found) == 1
    assert found[0].startswith(f"{name}:2: death: EXPECT_DEATH accepts any death; use EXPECT_CHECK_FAILS")


ACCEPTS_ANY = [
    'EXPECT_DEATH(f(), "\\n");',
    'EXPECT_DEATH(f(), "[a-z]");',
    'EXPECT_DEATH(f(), " ");',
    'EXPECT_DEATH(f(), "ERROR");',
    'EXPECT_DEATH(f(), ::testing::_);',
    'EXPECT_DEATH(f(), _);',
    'EXPECT_DEATH(f(), "");',
    'ASSERT_DEATH(f(), "");',
    'EXPECT_EXIT(f(), ::testing::KilledBySignal(SIGILL), "");',
    'ASSERT_EXIT(f(), is_halt, "") << "output";',
    'EXPECT_DEATH_IF_SUPPORTED(f(), "");',
    'EXPECT_DEBUG_DEATH(f(), "");',
    'EXPECT_DEATH(f("a, b", \'"\', (1, 2)), "");',
    'EXPECT_DEATH(\n    {\n        f();  // "cause"\n    },\n    "");',
    'EXPECT_DEATH(f(), "" /* "cause" */);',
    'EXPECT_DEATH(f(), "" "");',
    'EXPECT_DEATH(f(), R"()");',
    'EXPECT_DEATH(f(), R"x(.*)x");',
    'EXPECT_DEATH(f(), ".*");',
    'EXPECT_DEATH(f(), ".");',
    'EXPECT_DEATH(f(), "cause|");',
    'EXPECT_DEATH(f(), "x?");',
    'EXPECT_DEATH(f(), "[[:alpha:]]*");',
    'EXPECT_DEATH(f(), ::testing::HasSubstr(""));',
    'EXPECT_DEATH(f(), std::string("" ));',
    "EXPECT_DEATH(f(), std::string{});",
    'EXPECT_DEATH(f(), ""s);',
]
STATES_CAUSE = [
    'EXPECT_CHECK_FAILS(f(), "span.hpp", 1);',
    'EXPECT_DEATH(f(), "cause");',
    'EXPECT_DEATH(f(""), "cause") << "";',
    'EXPECT_EXIT(f(), ::testing::KilledBySignal(SIGSEGV), "^$");',
    'EXPECT_DEATH(f(), "" "cause");',
    'EXPECT_DEATH(f(), "see // cause");',
    'EXPECT_DEATH(f(), R"(cause)");',
    'EXPECT_DEATH(f(), ::testing::HasSubstr("cause"));',
    "EXPECT_EXIT(f(), is_halt, make_pattern());",
    "EXPECT_DEATH(f(), kPattern);",
    '// EXPECT_DEATH(f(), "");',
    'log("EXPECT_DEATH(f(), \\"\\")");',
    'EXPECT_EQ(f(), "");',
    'EXPECT_DEATH(f(), "(");',
]


@pytest.mark.parametrize("text", ACCEPTS_ANY)
@pytest.mark.verifies("SWR-VER-024", technique="equivalence_classes", polarity="violation")
def test_pattern_that_accepts_unrelated_output_is_found_with_its_line(text: str) -> None:
    assert [line for line, _ in check_death_tests(f'EXPECT_DEATH(g(1), "check 1");\n\n{text}\n')] == [3]


@pytest.mark.parametrize("text", STATES_CAUSE)
@pytest.mark.verifies("SWR-VER-024", technique="equivalence_classes")
def test_pattern_that_states_the_cause_is_no_finding(text: str) -> None:
    assert list(check_death_tests(f"{text}\n")) == []
