# SPDX-License-Identifier: Apache-2.0
# Goal: the records of a run contain the hash of each evidence file and of its inputs, and the trace tool accepts them.
from __future__ import annotations

import hashlib
import io
import json
from pathlib import Path

import pytest

from mamori_tools.host.environment import write_environment
from mamori_tools.host.project import Project
from mamori_tools.host.records import record_evidence, renew_records
from mamori_tools.host.steps import Context
from mamori_trace.base.errors import WorkError
from mamori_trace.base.finding import Problem
from mamori_trace.model.evidence import Evidence
from mamori_trace.readers.evidence_records import read_evidence_records


@pytest.fixture
def project(tmp_path: Path) -> Project:
    """Evidence of one C++ program and of Python tests."""
    made = Project(tmp_path)
    program = made.build / "safety" / "safety_gate_test"
    program.parent.mkdir(parents=True)
    program.write_bytes(b"program")
    program.chmod(0o755)
    made.junit.mkdir(parents=True)
    (made.junit / "safety_gate_test.xml").write_text("<testsuites/>")
    (made.junit / "python-tools.xml").write_text("<testsuites/>")
    return made


def read_back(project: Project) -> tuple[Evidence, list[str]]:
    evidence = Evidence()
    problems: list[Problem] = []
    read_evidence_records(project.evidence, project.root, evidence, problems)
    return evidence, [f"{problem.place.file}: {problem.message}" for problem in problems]


@pytest.mark.verifies("SWR-TRC-036", technique="interface")
def test_each_file_is_recorded_with_what_made_it(project: Project) -> None:
    write_environment(project, ["./mamori", "test"])
    log = io.StringIO()

    record_evidence(Context(project, 1), lambda *_: None, log)

    rows = json.loads((project.evidence / "records.json").read_text())["files"]
    inputs = json.loads((project.evidence / "environment.json").read_text())["inputs"]
    assert list(rows) == ["environment.json", "junit/python-tools.xml", "junit/safety_gate_test.xml"]
    assert rows["junit/safety_gate_test.xml"]["binary"] == hashlib.sha256(b"program").hexdigest()
    assert rows["junit/python-tools.xml"]["binary"] is None
    assert all({**inputs, "sha256": row["sha256"], "binary": row["binary"]} == row for row in rows.values())
    assert read_back(project)[1] == []
    assert log.getvalue() == "3 files recorded\n"


@pytest.mark.verifies("SWR-TRC-036", technique="state_transition")
def test_a_command_that_measures_again_renews_its_records_only(project: Project) -> None:
    write_environment(project, ["./mamori", "test"])
    new = project.evidence / "coverage" / "coverage.json"
    new.parent.mkdir()
    new.write_text("{}")
    inputs = {"sources": "1" * 64, "tool_chain": "2" * 64, "configuration": "3" * 64}
    renew_records(project, [new], inputs)
    assert not (project.evidence / "records.json").exists()

    record_evidence(Context(project, 1), lambda *_: None, io.StringIO())
    new.write_text('{"again": 1}')
    assert len(read_back(project)[1]) == 1
    renew_records(project, [new], inputs)

    evidence, problems = read_back(project)
    assert problems == []
    assert evidence.records["coverage/coverage.json"].sources == "1" * 64


@pytest.mark.verifies("SWR-TRC-036", technique="error_guessing", polarity="violation")
def test_without_a_whole_environment_nothing_is_recorded(project: Project) -> None:
    for text in (None, "{", "{}"):
        if text is not None:
            (project.evidence / "environment.json").write_text(text)
        with pytest.raises(WorkError, match=r"environment.json"):
            record_evidence(Context(project, 1), lambda *_: None, io.StringIO())
        assert not (project.evidence / "records.json").exists()
