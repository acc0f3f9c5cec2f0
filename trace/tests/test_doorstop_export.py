# SPDX-License-Identifier: Apache-2.0
# Goal: a Doorstop export is one tree of documents without loss, or nothing is written.
# Method: items, including unsuitable ids, texts and locations, are exported and read by the Doorstop reader.
from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from trace_sample import Outcome, Sample, format_item

from mamori_trace.formats import doorstop
from mamori_trace.formats.own import make_neutral
from mamori_trace.formats.writers import FOLDER_WRITERS, WRITERS
from mamori_trace.readers.project import read_requirements

HEAD = "ID,Title,Statement,Rationale,Parents,level,Status\n"


def read_settings(folder: Path) -> dict[str, dict]:
    return {path.parent.name: yaml.safe_load(path.read_text())["settings"] for path in sorted(folder.glob("*/.doorstop.yml"))}


def export_csv(trace: Callable[..., Outcome], tmp_path: Path, rows: str) -> Outcome:
    (tmp_path / "items.csv").write_text(HEAD + rows)
    return trace("export", "doorstop", "--format", "csv", tmp_path / "items.csv", "--out", tmp_path / "out")


def list_files(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.verifies("SWR-TRC-050", technique="back_to_back", polarity="nominal")
def test_every_part_of_every_item_comes_back(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    outcome = trace("export", "doorstop", "--root", sample.root, "--out", tmp_path / "out")
    trace("export", "doorstop", "--root", sample.root, "--out", tmp_path / "again")

    problems: list = []
    found = doorstop.read(tmp_path / "out", tmp_path, problems)
    rows = [{each.id: (each.title, each.statement, each.rationale, [link.target for link in each.relations], each.attributes) for each in items}
            for items in (found.items, make_neutral(read_requirements(sample.root)).items)]  # fmt: skip
    assert (outcome.status, problems, found.losses) == (0, [], [])
    assert rows[0] == rows[1]
    assert list_files(tmp_path / "out") == list_files(tmp_path / "again")
    judged = trace("check", "--format", "doorstop", tmp_path / "out", "--allow-missing", "--output", "json")
    assert len(judged.content["items"]) == 8


@pytest.mark.verifies("SWR-TRC-050", technique="requirements_based", polarity="nominal")
def test_documents_are_one_tree_along_the_links(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    trace("export", "doorstop", "--root", sample.root, "--out", tmp_path / "out")

    settings = read_settings(tmp_path / "out")
    assert {name: row.get("parent", "") for name, row in settings.items()} == {
        "HAZ": "", "STK": "HAZ", "SWR-SUP": "SYS", "SWR-TLS": "SYS", "SYS": "HAZ"}  # fmt: skip
    assert settings["SWR-SUP"] == {"digits": 3, "prefix": "SWR-SUP", "sep": "-", "parent": "SYS"}
    need = yaml.safe_load((tmp_path / "out" / "STK" / "STK-001.yml").read_text())
    assert (need["derived"], need["links"], need["reviewed"]) == (True, [], None)  # no missing parent is reported


@pytest.mark.verifies("SWR-TRC-050", technique="error_guessing", polarity="nominal")
def test_documents_that_link_each_other_are_no_ring(trace: Callable, tmp_path: Path) -> None:
    outcome = export_csv(trace, tmp_path, "A-1,,x,,B-1,,\nB-1,,x,,C-1,,\nC-1,,x,,A-1,,\nD_01,,x,,,,\nREQ7,,x,,,,\n")

    settings = read_settings(tmp_path / "out")
    assert outcome.status == 0, outcome.err
    assert {name: row.get("parent", "") for name, row in settings.items()} == {"A": "B", "B": "C", "C": "", "D": "C", "REQ": "C"}
    assert [(settings[name]["sep"], settings[name]["digits"]) for name in ("A", "D", "REQ")] == [("-", 1), ("_", 2), ("", 1)]


@pytest.mark.parametrize("text", ["First\n\n  - second: x\n# third", "null", "a \"b\" 'c' {d} [e] & *f", "tab\there ☂ ", "- x", "true", "---\n...", "%a"])
@pytest.mark.verifies("SWR-TRC-050", technique="error_guessing", polarity="violation")
def test_odd_texts_come_back(text: str, trace: Callable, tmp_path: Path) -> None:
    cell = text.replace('"', '""')
    outcome = export_csv(trace, tmp_path, f'R-1,"{cell}","{cell}","{cell}",,"{cell}",open\n')

    problems: list = []
    [item] = doorstop.read(tmp_path / "out", tmp_path, problems).items
    assert (outcome.status, problems) == (0, [])
    assert (item.statement, item.rationale, item.attributes["attribute-level"]) == (text.strip(), text.strip(), text.strip())
    assert yaml.safe_load((tmp_path / "out" / "R" / "R-1.yml").read_text())["text"].strip() == text.strip()


@pytest.mark.verifies("SWR-TRC-050", technique="requirements_based", polarity="nominal")
def test_a_retired_item_is_not_active(trace: Callable, tmp_path: Path) -> None:
    export_csv(trace, tmp_path, "R-1,,x,,,,retired\nR-2,,x,,,,open\n")

    active = [yaml.safe_load((tmp_path / "out" / "R" / f"R-{number}.yml").read_text())["active"] for number in (1, 2)]
    assert active == [False, True]


@pytest.mark.parametrize("row", ["../R-1,,x,,,,", "R/1,,x,,,,", "R,,x,,,,", "1,,x,,,,", "R-1 b-1,,x,,,,", "R-1,,x,,no id,,", "Ü-1,,x,,,,",
                                 f"A{'1' * 50_000}x,,x,,,,"])  # fmt: skip
@pytest.mark.verifies("SWR-TRC-050", technique="equivalence_classes", polarity="violation")
def test_an_id_that_doorstop_could_not_read_is_refused_with_its_place(row: str, trace: Callable, tmp_path: Path) -> None:
    outcome = export_csv(trace, tmp_path, f"R-9,,x,,,,\n{row}\n")

    assert (outcome.status, outcome.err.count("\n"), "items.csv:3: " in outcome.err) == (2, 1, True), outcome.err
    assert os.listdir(tmp_path) == ["items.csv"]


@pytest.mark.parametrize("kind", ["folder", "file", "link"])
@pytest.mark.verifies("SWR-TRC-050", technique="error_guessing", polarity="violation")
def test_what_is_there_already_stays(kind: str, sample: Sample, trace: Callable, tmp_path: Path) -> None:
    out = tmp_path / "out"
    makers: dict[str, Callable[[], None]] = {"folder": out.mkdir, "file": out.touch, "link": lambda: out.symlink_to("nowhere")}
    makers[kind]()

    outcome = trace("export", "doorstop", "--root", sample.root, "--out", out)

    assert (outcome.status, outcome.err) == (2, f"mamori trace: {out}: is there already, and a folder is never overwritten; remove it, "
                                                "or name another\n")  # fmt: skip
    assert sorted(os.listdir(tmp_path)) == ["out", "project"]


@pytest.mark.verifies("SWR-TRC-050", technique="fault_injection", polarity="violation")
def test_a_full_disk_leaves_no_half_of_a_folder(sample: Sample, trace: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = Path.write_text

    def fill(path: Path, *words: Any, **more: Any) -> int:
        if path.name == "SYS-002.yml":
            raise OSError(errno.ENOSPC, "No space left on device", str(path))
        return real(path, *words, **more)

    monkeypatch.setattr(Path, "write_text", fill)
    outcome = trace("export", "doorstop", "--root", sample.root, "--out", tmp_path / "out")

    assert (outcome.status, outcome.err.count("\n"), os.listdir(tmp_path)) == (2, 1, ["project"])
    assert "out: cannot be written: no room is left on the disk; " in outcome.err


@pytest.mark.parametrize("target", sorted({*WRITERS, *FOLDER_WRITERS}))
@pytest.mark.verifies("SWR-TRC-050", technique="fault_injection", polarity="violation")
def test_no_export_drops_one_of_two_items_with_one_id(target: str, sample: Sample, trace: Callable, tmp_path: Path) -> None:
    line = sample.append("requirements/system/system.md", format_item("SYS-003", "Again", "The tool shall be again.", Parents="STK-001"))

    outcome = trace("export", target, "--root", sample.root, "--out", tmp_path / "out")

    assert (outcome.status, os.listdir(tmp_path)) == (2, ["project"])
    assert f"requirements/system/system.md:{line}: SYS-003 is defined at requirements/system/system.md:" in outcome.err
