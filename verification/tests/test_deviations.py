# SPDX-License-Identifier: Apache-2.0
# Goal: an assembler statement without a row, a row without a statement, and an incomplete row are found.
# Method: one source and one row, each with one fault; the shipped tree.
from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from mamori_tools.host.project import ROOT
from verification.checks.check_layers import check_tree
from verification.checks.deviations import FILE, check_deviations

CODE = "safety/src/a.cpp"
GOOD_CODE = 'void keep(int a) {\n    asm volatile("" : "+m"(a));  // DEV-007\n}\n'
GOOD_ROW = {
    "id": "DEV-007",
    "rule": "10.4.1",
    "file": CODE,
    "function": "keep",
    "reason": "why",
    "safe_because": "how",
    "agreed": "decision.md",
}


def check(root: Path, rows: object, code: str = GOOD_CODE) -> list[str]:
    (root / "decision.md").touch()
    (root / FILE).parent.mkdir(exist_ok=True)
    (root / FILE).write_text(yaml.safe_dump({"deviations": rows}), encoding="utf-8")
    return [f"{file}:{line}: {message}" for file, line, _, message in check_deviations(root, {CODE: code})]


@pytest.mark.verifies("SWR-SLF-020")
def test_shipped_rows_and_statements_belong_together() -> None:
    assert [finding for finding in check_tree(ROOT) if finding.rule == "deviation"] == []
    assert len(yaml.safe_load((ROOT / FILE).read_text(encoding="utf-8"))["deviations"]) == 2


@pytest.mark.verifies("SWR-SLF-020", technique="equivalence_classes")
def test_statement_with_its_row_is_no_finding(tmp_path: Path) -> None:
    assert check(tmp_path, [GOOD_ROW]) == []
    assert check(tmp_path, [], "int asmara;  // asm in words\nconst char* text = \"asm\";\n") == []


@pytest.mark.verifies("SWR-SLF-020", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("word", ["asm", "__asm", "__asm__"])
def test_statement_without_a_row_is_found(tmp_path: Path, word: str) -> None:
    (found,) = check(tmp_path, [], f'void keep() {{\n    {word}("");\n}}\n')

    assert found.startswith(f"{CODE}:2: assembler statement without a row")


@pytest.mark.verifies("SWR-SLF-020", technique="fault_injection", polarity="violation")
def test_identifier_without_a_row_is_found(tmp_path: Path) -> None:
    assert check(tmp_path, []) == [f"{CODE}:2: DEV-007 is no sound row for this file in {FILE}"]


@pytest.mark.verifies("SWR-SLF-020", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("rule", "", "needs a text in each of"),
        ("rule", 10.4, "needs a text in each of"),
        ("more", "text", "needs a text in each of"),
        ("id", "DEV-7", "is no identifier"),
        ("file", "safety/src/b.cpp", "is no source of a target layer"),
        ("function", "kee", "has no function"),
        ("id", "DEV-008", "names DEV-008"),
        ("agreed", "nobody.md", "is no file"),
    ],
)
def test_wrong_row_is_found(tmp_path: Path, field: str, value: object, message: str) -> None:
    found = check(tmp_path, [{**GOOD_ROW, field: value}])

    assert found[0].startswith(f"{FILE}:1: row 1: ")
    assert message in found[0]


@pytest.mark.verifies("SWR-SLF-020", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("rows", "message"),
    [([GOOD_ROW, GOOD_ROW], "row 2: DEV-007 stands there twice"), ({}, "has no list"), (["DEV-007"], "row 1: needs a text in each of")],
)
def test_wrong_table_is_found(tmp_path: Path, rows: object, message: str) -> None:
    assert message in check(tmp_path, rows)[0]


@pytest.mark.verifies("SWR-SLF-020", technique="error_guessing", polarity="violation")
def test_file_that_is_no_yaml_is_found(tmp_path: Path) -> None:
    (tmp_path / FILE).parent.mkdir()
    (tmp_path / FILE).write_text("deviations: [", encoding="utf-8")

    ((file, _, _, message),) = check_deviations(tmp_path, {})

    assert file == FILE
    assert message.startswith("no YAML")
