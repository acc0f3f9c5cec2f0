# SPDX-License-Identifier: Apache-2.0
# Goal: export and import lose nothing; parts that cannot be imported are reported with location; files are complete or absent.
# Method: the sample project and generated ones are exported, imported into a new folder, and exported again; the files are compared.
from __future__ import annotations

import csv
import io
import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest
from faulty.generate import generate
from faulty.writers import add_native_schema
from reqif.cli.cli_arg_parser import ValidateCommandConfig
from reqif.commands.validate.validate import ValidateCommand
from reqif.parser import ReqIFParser
from trace_sample import Sample

from mamori_trace.base.finding import Place, Problem
from mamori_trace.formats.csv_file import _read_rows, escape_cell, format_csv, unescape_cell
from mamori_trace.formats.model import ForeignItem, ForeignProject
from mamori_trace.readers.project import read_requirements

_PAGE = '<?xml version="1.0"?>\n<REQ-IF xmlns="http://www.omg.org/spec/ReqIF/20110401/reqif.xsd">\n'


def _make_empty(root: Path) -> Path:
    add_native_schema(root)
    return root


def _list_items(root: Path) -> list[object]:
    """Every attribute of every item in order, and the reviews, as the readers return them."""
    project = read_requirements(root)
    assert project.problems == []
    rows = []
    for item in project.all_items:
        words = {name: getattr(item, name) for name in ("id", "title", "level", "statement", "rationale", "parents", "sil", "verify",
                                                        "polarity", "design", "status")}  # fmt: skip
        rows.append({**words, "file": item.place.file, "line": item.place.line, "fingerprint": item.calc_fingerprint()})
    reviews = project.lock.reviews if project.lock else {}
    return [*rows, *sorted(map(repr, reviews.values()))]


@pytest.mark.verifies("SWR-TRC-051", technique="back_to_back", polarity="nominal")
def test_reqif_there_and_back_is_identical(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    empty = _make_empty(tmp_path / "second")
    first, second = tmp_path / "first.reqif", tmp_path / "second.reqif"

    statuses = [
        trace("export", "reqif", "--out", first, "--root", sample.root).status,
        trace("import", "reqif", first, "--into", "requirements", "--root", empty).status,
        trace("export", "reqif", "--out", second, "--root", empty).status,
    ]

    assert statuses == [0, 0, 0]
    assert _list_items(empty) == _list_items(sample.root)
    assert second.read_bytes() == first.read_bytes()


@pytest.mark.parametrize("text", ["a < b & \"c\" > 'd'", "Übung, 测试 – ok", "tab\there", "]]> &amp; <!--"])
@pytest.mark.verifies("SWR-TRC-051", technique="error_guessing", polarity="violation")
def test_odd_letters_survive_reqif(text: str, sample: Sample, trace: Callable, tmp_path: Path) -> None:
    sample.replace("requirements/system/system.md", "The tool shall run offline.", f"The tool shall run {text} offline.")
    empty = _make_empty(tmp_path / "second")
    trace("export", "reqif", "--out", tmp_path / "a.reqif", "--root", sample.root)

    trace("import", "reqif", tmp_path / "a.reqif", "--into", "requirements", "--root", empty)

    statements = {item.statement for item in read_requirements(empty).all_items}
    assert f"The tool shall run {' '.join(text.split())} offline." in {" ".join(each.split()) for each in statements}


@pytest.mark.parametrize("name", ["native", "strictdoc", "oft", "needs"])
@pytest.mark.verifies("SWR-TRC-050", technique="back_to_back", polarity="nominal")
def test_the_reqif_package_reads_exports_without_an_error(
    name: str, trace: Callable, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    generate(name, "", tmp_path / "project")
    chosen = ("--root", tmp_path / "project") if name == "native" else ("--format", name, tmp_path / "project")

    outcome = trace("export", "reqif", "--out", tmp_path / "a.reqif", *chosen)

    assert outcome.status == 0, outcome.err
    bundle = ReqIFParser.parse(str(tmp_path / "a.reqif"))
    content = bundle.core_content.req_if_content
    assert (bundle.exceptions, len(content.spec_objects), len(content.spec_relations)) == ([], 100, 90)
    with pytest.raises(SystemExit) as ended:
        ValidateCommand.execute(ValidateCommandConfig(str(tmp_path / "a.reqif"), use_reqif_schema=True))
    assert ended.value.code == 0, capsys.readouterr().out


@pytest.mark.parametrize("target", ["csv", "json", "needs", "oft", "strictdoc", "reqif"])
@pytest.mark.verifies("SWR-TRC-050", technique="equivalence_classes", polarity="nominal")
def test_what_is_exported_can_be_read_again(target: str, sample: Sample, trace: Callable, tmp_path: Path) -> None:
    file = tmp_path / {"needs": "needs.json", "oft": "a.md", "strictdoc": "a.sdoc"}.get(target, f"a.{target}")

    twice = [(trace("export", target, "--out", file, "--root", sample.root).status, file.read_bytes()) for _ in range(2)]

    assert (twice[0], twice[0][0]) == (twice[1], 0)
    if target == "json":
        rows = json.loads(twice[0][1])["items"]
        assert [(row["id"], row["relations"][0]["review"].split()[2]) for row in rows if row["id"] == "SYS-003"] == [("SYS-003", "2026-11-21")]
        return
    again = trace("check", "--format", target, file, "--allow-missing", "--output", "json")
    assert len(again.content["items"]) == 8
    statements = {"SYS-003": "The tool shall run offline.", "req~SYS-003~1": "The tool shall run offline."}
    assert any(row["id"] in statements and row["statement"] == statements[row["id"]] for row in again.content["items"])


@pytest.mark.verifies("SWR-TRC-050", technique="fault_injection", polarity="violation")
def test_an_export_of_broken_items_writes_nothing(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    sample.replace("requirements/system/system.md", "## SYS-003 Tool", "## SYS-3 Tool")

    outcome = trace("export", "reqif", "--out", tmp_path / "a.reqif", "--root", sample.root)

    assert (outcome.status, outcome.err.count("\n"), (tmp_path / "a.reqif").exists()) == (2, 1, False)


@pytest.mark.parametrize(("name", "count"), [("strictdoc", 100), ("oft", 100), ("needs", 100)])
@pytest.mark.verifies("SWR-TRC-049", technique="requirements_based", polarity="nominal")
def test_an_import_keeps_every_item_with_a_new_id(name: str, count: int, trace: Callable, tmp_path: Path) -> None:
    generate(name, "", tmp_path / "old")
    empty = _make_empty(tmp_path / "new")

    outcome = trace("import", name, tmp_path / "old", "--into", "requirements/taken", "--area", "TAKE", "--root", empty)

    project = read_requirements(empty)
    assert (outcome.status, project.problems, len(project.items)) == (0, [], count), outcome.err
    rows = (empty / "requirements" / "taken" / "import_map.csv").read_text().splitlines()
    assert (rows[0], len(rows)) == ("old,new,file,line", count + 1)
    below = project.items["SWR-TAKE-001"]
    assert (below.parents, below.statement) == (("SYS-001",), "The software shall report value 1 when it leaves its range.")


@pytest.mark.verifies("SWR-TRC-049", technique="requirements_based", polarity="violation")
def test_what_is_not_taken_over_is_told_with_its_place(trace: Callable, tmp_path: Path) -> None:
    text = """[DOCUMENT]
TITLE: Arm

[TEXT]
STATEMENT: An introduction.

[REQUIREMENT]
UID: A-1
OWNER: maintainers
TITLE: First
STATEMENT: >>>
One.

Two.
<<<
RELATIONS:
- TYPE: File
  VALUE: src/a.cpp
- TYPE: Parent
  VALUE: A-9
"""
    (tmp_path / "a.sdoc").write_text(text)
    empty = _make_empty(tmp_path / "new")

    outcome = trace("import", "strictdoc", tmp_path / "a.sdoc", "--into", "requirements/taken", "--root", empty)

    for place in ("a.sdoc:4: ", "a.sdoc:9: not taken over: A-1: attribute OWNER", "a.sdoc:18: not taken over: A-1: relation to the file",
                  "a.sdoc:20: not taken over: A-1: relation Parent to A-9", "A-1: line breaks of the statement", "A-1: no sil"):  # fmt: skip
        assert place in outcome.out, outcome.out
    assert outcome.status == 0


@pytest.mark.verifies("SWR-TRC-049", technique="fault_injection", polarity="violation")
def test_an_import_overwrites_nothing_and_leaves_nothing_behind(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    generate("oft", "", tmp_path / "old")
    trace("export", "reqif", "--out", tmp_path / "own.reqif", "--root", sample.root)
    (tmp_path / "cut.md").write_text("`req~a~1`\n\nIt shall.\n\n```\n")
    before = {path: path.read_bytes() for path in sample.root.rglob("*") if path.is_file()}

    outcomes = [
        trace("import", "reqif", tmp_path / "own.reqif", "--into", "requirements/again", "--root", sample.root),
        trace("import", "oft", tmp_path / "cut.md", "--into", "requirements/new", "--root", sample.root),
        trace("import", "oft", tmp_path / "old", "--into", "../elsewhere", "--root", sample.root),
        trace("import", "oft", tmp_path / "old", "--into", "requirements/new", "--area", "lower", "--root", sample.root),
        trace("import", "needs", tmp_path / "old", "--into", "requirements/new", "--root", sample.root),
    ]

    assert [(each.status, each.out, each.err.count("\n")) for each in outcomes] == [(2, "", 1)] * len(outcomes)
    assert {path: path.read_bytes() for path in sample.root.rglob("*") if path.is_file()} == before


@pytest.mark.verifies("SWR-TRC-049", technique="equivalence_classes", polarity="nominal")
def test_an_import_goes_on_behind_the_ids_that_were_ever_used(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    generate("oft", "", tmp_path / "old")
    (sample.root / "requirements" / "notes.md").write_text("SYS-041 was given up.\n")

    outcome = trace("import", "oft", tmp_path / "old", "--into", "requirements/taken", "--area", "SUP", "--root", sample.root)

    assert outcome.status == 0, outcome.err
    new = {row.split(",")[1] for row in (sample.root / "requirements/taken/import_map.csv").read_text().splitlines()[1:]}
    assert "there is no history of git at hand" in outcome.err
    assert {"SYS-042", "SWR-SUP-003"} <= new  # SWR-SUP-002 is an item of the sample
    assert not {"SYS-001", "SYS-041", "SWR-SUP-001", "SWR-SUP-002"} & new


@pytest.mark.verifies("SWR-TRC-049", technique="error_guessing", polarity="violation")
def test_what_was_taken_over_is_not_taken_over_again(trace: Callable, tmp_path: Path) -> None:
    generate("oft", "", tmp_path / "old")
    empty = _make_empty(tmp_path / "new")
    assert trace("import", "oft", tmp_path / "old", "--into", "requirements/taken", "--root", empty).status == 0

    again = trace("import", "oft", tmp_path / "old", "--into", "requirements/more", "--area", "MORE", "--root", empty)

    assert (again.status, again.err.count("\n")) == (2, 1)
    assert "requirements/taken/import_map.csv:2: " in again.err and "was taken over before, as " in again.err
    assert not (empty / "requirements" / "more").exists()


@pytest.mark.verifies("SWR-TRC-049", technique="fault_injection", polarity="violation")
def test_a_file_in_the_way_stops_the_import_before_the_first_is_written(trace: Callable, tmp_path: Path) -> None:
    generate("oft", "", tmp_path / "old")
    empty = _make_empty(tmp_path / "new")
    (empty / "requirements" / "requirements.md").write_text("# Mine\n")

    outcome = trace("import", "oft", tmp_path / "old", "--into", "requirements", "--root", empty)

    assert (outcome.status, "requirements.md" in outcome.err) == (2, True)
    assert sorted(path.name for path in (empty / "requirements").iterdir()) == ["requirements.md", "schema"]


@pytest.mark.parametrize(
    ("text", "line", "word"),
    [
        (_PAGE + "<CORE-CONTENT>", 3, "whole XML"),
        ('<!DOCTYPE a [<!ENTITY b "bbbb"><!ENTITY c "&b;&b;">]>\n<REQ-IF>&c;</REQ-IF>', 1, "document type"),
        ("<other/>", 1, "no ReqIF"),
        ("<a>" * 2000, 1, "nested"),
        (b"<REQ-IF>\xff</REQ-IF>", 1, "whole XML"),
        ("", 1, "whole XML"),
    ],
)
@pytest.mark.verifies("SWR-TRC-048", technique="fault_injection", polarity="violation")
def test_broken_reqif_is_one_finding(text: str | bytes, line: int, word: str, trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "a.reqif").write_bytes(text.encode() if isinstance(text, str) else text)

    outcome = trace("check", "--format", "reqif", tmp_path, "--allow-missing", "--output", "json")

    found = [(row["rule"], row["line"], word in row["message"]) for row in outcome.content["findings"]]
    assert (outcome.status, found) == (2, [("unreadable-input", line, True)])


@pytest.mark.parametrize(
    ("text", "line", "word"),
    [("Name,Text\na,b\n", 1, "column of ids"), ("ID,Text\nA-1\n", 2, "cells"), ("ID,Text\n,b\n", 2, "no id"), ('ID,Text\nA-1,"b\n', 2, "whole CSV"),
     (b"ID,Text\nA-1,\xff\n", 2, "UTF-8")],
)  # fmt: skip
@pytest.mark.verifies("SWR-TRC-048", technique="fault_injection", polarity="violation")
def test_broken_csv_is_one_finding(text: str | bytes, line: int, word: str, trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_bytes(text.encode() if isinstance(text, str) else text)

    outcome = trace("check", "--format", "csv", tmp_path, "--allow-missing", "--output", "json")

    found = [(row["rule"], row["line"], word in row["message"]) for row in outcome.content["findings"]]
    assert (outcome.status, found) == (2, [("unreadable-input", line, True)])



_HALF = '{"versions": {"1": {"needs": {"A_1": {"id": "A_1", "title": "\\ud800", "content": "It shall.", "type": "req"}}}}}'


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("import", "needs", "needs.json", "--into", "requirements/taken"), "UTF-8"),
        (("new", "SYS", "--parents", "STK-001", "--title", "\udcff", "--file", "requirements/system/system.md"), "UTF-8"),
        (("export", "csv", "--out", ""), "names no file"),
        (("export", "csv", "--out", "pipe"), "is a folder or a device"),
        (("report", "--out", "requirements"), "is a folder or a device"),
    ],
)
@pytest.mark.verifies("SWR-TRC-009", technique="error_guessing", polarity="violation")
def test_what_no_file_can_hold_is_told_and_leaves_nothing_behind(
    arguments: tuple[str, ...], word: str, sample: Sample, trace: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(sample.root)
    (sample.root / "needs.json").write_text(_HALF, encoding="utf-8")
    os.mkfifo("pipe")
    before = {path: path.read_bytes() for path in sample.root.rglob("*") if path.is_file()}

    outcome = trace(*arguments)

    assert (outcome.status, outcome.out) == (2, "")
    assert word in outcome.err
    assert Path("pipe").is_fifo()
    assert {path: path.read_bytes() for path in sample.root.rglob("*") if path.is_file()} == before


CELLS = ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", "'=1", "''=1", "'word", "'", "''", "a=b", "", "=cmd|' /C calc'!A0", "'\t", "-"]


@pytest.mark.parametrize("cell", CELLS, ids=range(len(CELLS)))
@pytest.mark.verifies("SWR-TRC-107", technique="equivalence_classes", polarity="nominal")
def test_a_csv_cell_comes_back_as_it_was(cell: str) -> None:
    item = ForeignItem("REQ-1", cell or "t", Place("a.csv", 2), rationale=cell)
    item.statement = cell
    item.attributes = {"Note": cell, "=Note": cell}
    text = format_csv(ForeignProject("csv", [item]))

    problems: list[Problem] = []
    found = ForeignProject("csv")
    _read_rows(csv.reader(io.StringIO(text, newline=""), strict=True), "a.csv", found, problems)

    back = found.items[0]
    assert problems == [] and (back.statement, back.rationale, back.attributes) == (cell, cell, {"Note": cell, "=Note": cell})
    assert unescape_cell(escape_cell(cell)) == cell


@pytest.mark.verifies("SWR-TRC-107", technique="error_guessing", polarity="violation")
def test_no_csv_cell_is_a_formula(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    sample.replace("requirements/system/system.md", "The tool shall run offline.", "=HYPERLINK(A1) shall run offline.")
    sample.replace("requirements/system/system.md", "## SYS-003 Tool", "## SYS-003 @SUM")

    outcome = trace("export", "csv", "--out", tmp_path / "a.csv", "--root", sample.root)

    cells = [cell for row in csv.reader((tmp_path / "a.csv").open(newline="")) for cell in row]
    assert outcome.status == 0 and not [cell for cell in cells if cell[:1] in ("=", "+", "-", "@", "\t", "\r")]
    again = trace("check", "--format", "csv", tmp_path / "a.csv", "--allow-missing", "--json")
    row = next(row for row in again.content["items"] if row["id"] == "SYS-003")
    assert (row["statement"], row["title"]) == ("=HYPERLINK(A1) shall run offline.", "@SUM")


@pytest.mark.verifies("SWR-TRC-107", technique="error_guessing", polarity="violation")
def test_the_map_of_an_import_holds_no_formula(trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "old.csv").write_text("ID,Title,Statement\n@REQ-1,Stop,The arm shall stop.\n")
    empty = _make_empty(tmp_path / "new")
    words = ("import", "csv", tmp_path / "old.csv", "--into", "requirements/taken", "--root", empty)

    assert trace(*words).status == 0

    assert "\n'@REQ-1," in (empty / "requirements/taken/import_map.csv").read_text()
    again = trace(*(word if word != "requirements/taken" else "requirements/again" for word in words))
    assert again.status == 2 and "was taken over before" in again.err
