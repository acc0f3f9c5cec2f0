# SPDX-License-Identifier: Apache-2.0
# Goal: an input that is not readable as ReqIF or as a result is one finding with a remedy; the command never waits forever.
# Method: packed archives, pipes, unknown encodings and broken links are given to the command.
from __future__ import annotations

import os
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from trace_sample import Outcome

_SPEC = "## Stop\n`req~stop~1`\n\nThe arm shall stop.\n\nNeeds: utest\n"
_REQIF = '<REQ-IF xmlns="http://www.omg.org/spec/ReqIF/20110401/reqif.xsd"/>\n'


def list_broken(outcome: Outcome) -> list[tuple[str, int, str]]:
    return [(row["file"], row["line"], row["message"]) for row in outcome.content["findings"] if row["rule"] == "unreadable-input"]


@pytest.mark.parametrize("whole_folder", [False, True])
@pytest.mark.verifies("SWR-TRC-048", technique="error_guessing", polarity="violation")
def test_a_packed_reqif_is_to_be_unpacked(whole_folder: bool, trace: Callable, tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "a.reqifz", "w") as archive:
        archive.writestr("a.reqif", _REQIF)

    outcome = trace("check", "--format", "reqif", tmp_path if whole_folder else tmp_path / "a.reqifz", "--allow-missing", "--output", "json")

    ((file, line, message),) = list_broken(outcome)
    assert (outcome.status, file, line, "unpack it" in message) == (2, "a.reqifz", 1, True)


@pytest.mark.parametrize(
    ("text", "line", "word"),
    [('<?xml version="1.0" encoding="latin-99"?>\n' + _REQIF, 1, "encoding"), ("<!DOCTYPE a>\n" + _REQIF, 1, "DTD"), (_REQIF[:20], 1, "whole XML"),
     ("<a>\n" * 1100, 1001, "nested")],
    ids=["encoding", "doctype", "cut-off", "deep"],
)  # fmt: skip
@pytest.mark.verifies("SWR-TRC-048", technique="fault_injection", polarity="violation")
def test_a_broken_reqif_is_one_finding(text: str, line: int, word: str, trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "a.reqif").write_text(text, encoding="utf-8")

    outcome = trace("check", "--format", "reqif", tmp_path, "--allow-missing", "--output", "json")

    ((_, found, message),) = list_broken(outcome)
    assert (outcome.status, found, word in message) == (2, line, True)


@pytest.mark.verifies("SWR-TRC-048", technique="fault_injection", polarity="violation")
def test_pipes_among_the_files_are_told_and_not_waited_for(trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "a.md").write_text(_SPEC, encoding="utf-8")
    (tmp_path / "results").mkdir()
    os.mkfifo(tmp_path / "results" / "a.xml")
    os.mkfifo(tmp_path / "docs" / "a.reqif")

    results = trace("check", "--format", "oft", tmp_path / "docs", "--results", tmp_path / "results", "--output", "json")
    items = trace("check", "--format", "reqif", tmp_path / "docs" / ".", "--allow-missing")

    assert (results.status, [file.rpartition("/")[2] for file, _, _ in list_broken(results)]) == (2, ["a.xml"])
    assert items.status == 2


@pytest.mark.verifies("SWR-TRC-048", technique="error_guessing", polarity="violation")
def test_a_lost_link_is_named_and_not_what_it_leads_to(trace: Callable, tmp_path: Path) -> None:
    (tmp_path / "a.md").write_text(_SPEC, encoding="utf-8")
    (tmp_path / "b.md").symlink_to("gone/elsewhere.md")

    outcome = trace("check", "--format", "oft", tmp_path, "--allow-missing", "--output", "json")

    assert (outcome.status, [file for file, _, _ in list_broken(outcome)]) == (2, ["b.md"])
