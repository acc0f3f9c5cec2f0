# SPDX-License-Identifier: Apache-2.0
# Goal: a query selects the specified items; an error names its column; no query can exhaust the memory or the stack.
from __future__ import annotations

from collections.abc import Callable

import pytest
from trace_sample import Sample

from mamori_trace.base.errors import FormatError
from mamori_trace.model.query_syntax import MAX_DEPTH, MAX_LENGTH, parse

SYSTEM = "requirements/system/system.md"


@pytest.mark.parametrize(
    ("expression", "ids"),
    [
        ("level=SWR", "SWR-SUP-001 SWR-SUP-002 SWR-TLS-001"),
        ("level=swr and area=sup", "SWR-SUP-001 SWR-SUP-002"),
        ("sil>=2 and level=SYS", "SYS-001 SYS-002"),
        ("sil<1", "STK-001 SWR-TLS-001 SYS-003"),
        ("sil<=QM or sil>2", "STK-001 SWR-TLS-001 SYS-003"),
        ('text~"STOP"', "SYS-002"),
        ("parent=SYS-001", "SWR-SUP-001 SWR-SUP-002"),
        ("child=SWR-TLS-001", "SYS-003"),
        ("ancestor=STK-001 and level=SWR", "SWR-SUP-001 SWR-SUP-002 SWR-TLS-001"),
        ("descendant=SWR-SUP-002", "HAZ-001 STK-001 SYS-001"),
        ("has(code)", "SWR-SUP-001 SWR-SUP-002 SWR-TLS-001"),
        ("has(case)", "SYS-002"),
        ("not has(parent)", "HAZ-001 STK-001"),
        ("not level=SWR and not level=SYS", "HAZ-001 STK-001"),
        ("level=SWR or level=SYS and sil=QM", "SWR-SUP-001 SWR-SUP-002 SWR-TLS-001 SYS-003"),
        ("(level=SWR or level=SYS) and sil=QM", "SWR-TLS-001 SYS-003"),
        ("not (level=SWR or level=SYS)", "HAZ-001 STK-001"),
        ("not not level=HAZ", "HAZ-001"),
        ("polarity=violation and level=SWR", "SWR-SUP-001"),
        ("polarity!=violation and level=SWR", "SWR-SUP-002 SWR-TLS-001"),
        ("verdict=verified and id~TLS", "SWR-TLS-001"),
        ('verdict="not run"', ""),
        ("code~alive.hpp and code~latereporter", "SWR-SUP-002"),
        ("test~Silence and technique=fault_injection", "SWR-SUP-001"),
        ("title!~e and level=SYS", "SYS-003"),
        ("file=requirements/safety/hazards.md and line=3", "HAZ-001"),
        ("result=passed and sil=QM", "SWR-TLS-001"),
        ("verify=campaign", "SYS-002"),
        ("status=approved AND has(design) AND level!=SWR", "HAZ-001 SYS-001"),
    ],
)
@pytest.mark.verifies("SWR-TRC-079", technique="equivalence_classes", polarity="nominal")
def test_an_expression_selects_what_it_says(sample: Sample, trace: Callable, expression: str, ids: str) -> None:
    outcome = trace("query", expression, "--ids", "--root", sample.root)

    assert (outcome.status, outcome.out.split()) == (0, ids.split())


@pytest.mark.verifies("SWR-TRC-079", technique="requirements_based", polarity="nominal")
def test_the_answer_has_several_forms(sample: Sample, trace: Callable) -> None:
    query = ("query", "level=SYS and sil=2", "--root", sample.root)

    assert trace(*query, "--count").out == "2\n"
    assert trace(*query).out == "SYS-001  SIL 2   verified  Supervision\nSYS-002  SIL 2   verified  Freeze\n2 items\n"
    assert "| SYS-002 | Freeze | The arm shall stop when an encoder freezes. | HAZ-001 |" in trace(*query, "--markdown").out
    content = trace(*query, "--output", "json").content
    assert (content["count"], [row["id"] for row in content["items"]]) == (2, ["SYS-001", "SYS-002"])


@pytest.mark.verifies("SWR-TRC-079", technique="requirements_based", polarity="nominal")
def test_findings_and_objections_can_be_asked_for(sample: Sample, trace: Callable) -> None:
    sample.replace(SYSTEM, "The tool shall run", "The tool runs")

    suspects = trace("query", "rule=suspect-link", "--ids", "--root", sample.root)
    counted = trace("query", "rule=shall-count and has(rule)", "--ids", "--root", sample.root)

    assert "SYS-003" in suspects.out
    assert counted.out == "SYS-003\n"


@pytest.mark.parametrize(
    ("expression", "column", "word"),
    [
        ("", 1, "expected"),
        ("level", 6, "one of ="),
        ("level=", 7, "value"),
        ("levl=SWR", 1, "nearest: level"),
        ("level=SWT", 7, "nearest: SWR"),
        ("sil>=5", 6, "no sil"),
        ("level>SWR", 1, "no order"),
        ("verdict=verifid", 9, "nearest: verified"),
        ("parent=SYS-04", 8, "nearest: SYS-0"),
        ("has(cod)", 5, "nearest: code"),
        ("has code", 5, "brackets"),
        ("has()", 4, "brackets"),
        ("level=SWR and", 14, "expected"),
        ("and level=SWR", 1, "'"),
        ("level=SWR level=SYS", 11, "'and', 'or'"),
        ("(level=SWR", 1, "not closed"),
        ("level=SWR)", 10, "closes nothing"),
        ('text~"stop', 6, "not closed"),
        ("level=SWR ! sil=2", 11, "not understood"),
        ("line>=two", 7, "line number"),
        ("()", 2, "field"),
        ('"level"=SWR', 1, "field"),
    ],
)
@pytest.mark.verifies("SWR-TRC-080", technique="error_guessing", polarity="violation")
def test_a_wrong_expression_is_one_error_with_its_column(sample: Sample, trace: Callable, expression: str, column: int, word: str) -> None:
    outcome = trace("query", expression, "--root", sample.root)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert f"column {column}: " in outcome.err
    assert word in outcome.err


@pytest.mark.verifies("SWR-TRC-080", technique="boundary_values", polarity="violation")
def test_depth_and_length_have_limits() -> None:
    assert parse("(" * MAX_DEPTH + "sil=1" + ")" * MAX_DEPTH)
    assert parse(" and ".join(["sil=1"] * 900))
    for text in ("(" * (MAX_DEPTH + 1) + "sil=1" + ")" * (MAX_DEPTH + 1), "not " * (MAX_DEPTH + 1) + "sil=1", "x" * (MAX_LENGTH + 1)):
        with pytest.raises(FormatError):
            parse(text)


@pytest.mark.verifies("SWR-TRC-080", technique="error_guessing", polarity="violation")
def test_a_sign_in_a_value_is_told_how_to_be_written(sample: Sample, trace: Callable) -> None:
    outcome = trace("query", "id=req~stop~1", "--root", sample.root)

    assert (outcome.status, outcome.err.count("\n"), "quotation marks" in outcome.err) == (2, 1, True)
