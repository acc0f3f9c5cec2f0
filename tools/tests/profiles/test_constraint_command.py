# SPDX-License-Identifier: Apache-2.0
# Goal: the command shows the C++ form of a constraint, or why it is rejected. test_bad_input.py tests bad arguments.
from __future__ import annotations

import pytest

from mamori_tools.command.main import main


@pytest.mark.verifies("SWR-PAR-010")
def test_constraint_is_shown_in_canonical_form_and_in_cpp(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["constraint", "{ gain: 0<x, offset: }", "--type", "float", "--elements", "2"]) == 0
    assert capsys.readouterr().out == "canonical  x>0,\nC++        mamori::above(0.0F), mamori::any_value()\n"


@pytest.mark.verifies("SWR-PAR-010")
def test_names_of_an_enumeration_become_its_enumerators(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["constraint", "(slow,very_fast)", "--type", "robot::Mode", "--names", "off,slow,very_fast"]) == 0
    assert capsys.readouterr().out.splitlines()[1] == "C++        mamori::one_of(robot::Mode::kSlow, robot::Mode::kVeryFast)"


@pytest.mark.verifies("SWR-PAR-010", technique="boundary_values")
def test_greatest_number_of_elements_is_accepted(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["constraint", " -1<=x", "--elements", "65534"]) == 0
    assert "mamori::at_least(-1.0)" in capsys.readouterr().out


@pytest.mark.verifies("SWR-PAR-010", polarity="violation")
def test_rejected_text_is_shown_with_rule_and_column(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["constraint", "0.1<=x<=3.0a"]) == 2
    shown = capsys.readouterr()
    assert shown.err == "mamori: constraint: '0.1<=x<=3.0a': nothing or a comma is expected here (column 12)\n"
    assert shown.out == ""
