# SPDX-License-Identifier: Apache-2.0
# Goal: the SIL of an item determines the severity of a finding; an invalid pack is reported in one line.
from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Sample

from mamori_trace.base.finding import Place, Rule
from mamori_trace.checks import list_rules
from mamori_trace.model.item import Item, Schema
from mamori_trace.readers.rule_pack import SHIPPED, read_rule_pack, read_shipped_pack
from mamori_trace.readers.schema import read_schema

ROOT = Path(__file__).parents[2]
SYSTEM = "requirements/system/system.md"
PACK = "requirements/schema/rules.toml"


def write_pack(s: Sample, text: str) -> None:
    (s.root / PACK).write_text(f'schema = "mamori.rules/1"\n\n{text}', encoding="utf-8")


def make_item(sil: str, status: str = "approved") -> Item:
    return Item("SWR-SUP-001", "Silent", "SWR", Place("a.md", 1), sil=sil, status=status)


@pytest.fixture
def schema() -> Schema:
    return read_schema(ROOT)


@pytest.mark.parametrize(
    ("grades", "status", "severities"),
    [
        ('QM = "warning"\n2 = "error"', 1, {"SYS-001": "error", "SYS-003": "warning"}),
        ('QM = "warning"\n2 = "warning"', 0, {"SYS-001": "warning", "SYS-003": "warning"}),
        ('QM = "off"\n2 = "error"', 1, {"SYS-001": "error"}),
        ('all = "warning"\n2 = "off"', 0, {"SYS-003": "warning"}),
        ('all = "error"\napproved = "off"', 0, {}),
        ('QM = "warning"', 1, {"SYS-001": "error", "SYS-003": "warning"}),
    ],
)
@pytest.mark.verifies("SWR-TRC-020", technique="equivalence_classes", polarity="nominal")
def test_the_sil_of_the_item_decides(sample: Sample, trace: Callable, grades: str, status: int, severities: dict[str, str]) -> None:
    sample.replace(SYSTEM, "The kernel shall supervise", "The kernel supervises")
    sample.replace(SYSTEM, "The tool shall run", "The tool runs")
    sample.review()
    write_pack(sample, f"[rule.shall-count]\n{grades}\n")

    outcome = trace("check", "--root", sample.root, "--output", "json")

    assert outcome.status == status
    assert {finding["item"]: finding["severity"] for finding in outcome.content["findings"]} == severities


@pytest.mark.verifies("SWR-TRC-020", technique="boundary_values", polarity="nominal")
def test_a_finding_without_item_or_sil_gets_the_strictest_severity(sample: Sample, schema: Schema) -> None:
    write_pack(sample, '[rule.shall-count]\nall = "off"\n1 = "warning"\n')
    pack = read_rule_pack(sample.root, schema, [rule.id for rule in list_rules()])
    rule = Rule("shall-count", "error", "")

    assert [pack.get_severity(rule, item) for item in (None, make_item(""), make_item("QM"))] == ["warning", "warning", "off"]


@pytest.mark.verifies("SWR-TRC-020", technique="requirements_based", polarity="nominal")
def test_the_shipped_pack_holds_only_rules_that_exist_and_is_kept_where_the_project_says_nothing(
    sample: Sample, trace: Callable, schema: Schema
) -> None:
    write_pack(sample, '[rule.shall-count]\nall = "off"\n')

    pack = read_shipped_pack(schema)

    assert set(pack.grades) <= {rule.id for rule in list_rules()}
    assert "rule.sil-lower" in SHIPPED.read_text(encoding="utf-8")
    assert trace("check", "--root", sample.root).status == 0


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ('[rule.shall-cuont]\nall = "error"', "nearest: shall-count"),
        ('[rule.shall-count]\n4 = "error"', "'4' is no SIL"),
        ('[rule.shall-count]\naproved = "off"', "nearest: approved"),
        ('[rule.shall-count]\n2 = "eror"', "nearest: error"),
        ("[rule.shall-count]\n2 = 1", "severity 1"),
        ('[rule]\nshall-count = "error"', "no table"),
        ('[rules.shall-count]\n2 = "error"', "'rules'"),
        ('[rule.unreadable-input]\nall = "off"', "cannot be graded"),
        ("[rule.shall-count", "rules.toml"),
        ('rule = "off"', "unknown entry 'rule'"),
    ],
)
@pytest.mark.verifies("SWR-TRC-020", technique="error_guessing", polarity="violation")
def test_a_pack_that_cannot_be_understood_is_one_clear_line(sample: Sample, trace: Callable, text: str, named: str) -> None:
    write_pack(sample, text)

    outcome = trace("check", "--root", sample.root)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
    assert named in outcome.err and PACK in outcome.err


@pytest.mark.parametrize("data", [b'schema = "mamori.rules/2"', b"\xff\xfe"])
@pytest.mark.verifies("SWR-TRC-020", technique="error_guessing", polarity="violation")
def test_a_pack_of_another_schema_or_encoding_is_refused(sample: Sample, trace: Callable, data: bytes) -> None:
    (sample.root / PACK).write_bytes(data)

    outcome = trace("check", "--root", sample.root)

    assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
