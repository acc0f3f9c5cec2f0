# SPDX-License-Identifier: Apache-2.0
# Goal: the page shows the bytes of each system with its limit, aim and findings; an invalid record is a finding.
from __future__ import annotations

import copy
import json
from collections.abc import Callable
from typing import Any

import pytest
from trace_sample import Sample

IMAGE = {"name": "two", "title": "two components", "text": 1000, "ram": 500, "data": 400, "text_max": 1024, "ram_max": 512,
         "text_aim": 900, "ram_aim": None, "missed": True, "parts": {"kernel": 700, "safety": 11, "board": 289}, "findings": []}  # fmt: skip
MODES = {**IMAGE, "name": "modes", "title": "three modes", "text": 1777, "ram": 521, "text_aim": None, "missed": False,
         "findings": ["text takes 1777 bytes, 753 more than its limit of 1024"]}  # fmt: skip
RECORD = {"schema": "mamori.size/1", "compiler": "arm-none-eabi-g++ 12 -Os", "base": "two", "images": [IMAGE, MODES]}


@pytest.fixture
def report(sample: Sample, trace: Callable) -> Callable[..., tuple[str, Any]]:
    """Stores a record and writes the report. Returns the section "Timing" and the outcome."""

    def run(record: object = RECORD) -> tuple[str, Any]:
        folder = sample.evidence / "size"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "size.json").write_text(json.dumps(record), encoding="utf-8")
        outcome = trace("report", "--root", sample.root, "--output", "json")
        page = (sample.root / "report" / "index.html").read_text(encoding="utf-8")
        return page[page.index('<section id="timing"') : page.index('<section id="matrix"')], outcome

    return run


@pytest.mark.verifies("SWR-VER-031")
def test_page_shows_bytes_limits_aims_and_findings(report: Callable) -> None:
    section, outcome = report()

    assert outcome.status == 0
    for part in ("Memory of small systems", ">1000<", ">+777<", ">711<", ">1024<", ">+21<", "text 900 missed",
                 "modes: text takes 1777 bytes, 753 more than its limit of 1024", "arm-none-eabi-g++ 12 -Os"):  # fmt: skip
        assert part in section, part


@pytest.mark.verifies("SWR-VER-031")
def test_page_shows_which_aims_are_met(report: Callable) -> None:
    half = {**IMAGE, "text_aim": 999, "ram_aim": 500}

    section, _ = report({**RECORD, "images": [half]})

    assert "text 999 missed, RAM 500 met" in section


@pytest.mark.parametrize("defect", ["base", "schema", "text"])
@pytest.mark.verifies("SWR-VER-031", technique="error_guessing", polarity="violation")
def test_invalid_record_is_a_finding(report: Callable, defect: str) -> None:
    record = copy.deepcopy(RECORD)
    if defect == "text":
        record["images"][0]["text"] = "many"  # type: ignore[index]
    else:
        record[defect] = "another"

    section, outcome = report(record)

    assert "Memory of small systems" not in section
    assert any("size/size.json" in str(finding) for finding in outcome.content["findings"])
