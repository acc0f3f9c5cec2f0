# SPDX-License-Identifier: Apache-2.0
# Goal: the command prints one clear line on wrong usage, names similar ids, and records reviews of links.
from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from git_sample import start_history
from trace_sample import Sample

from mamori_trace.command import add_arguments, run

SYSTEM = "requirements/system/system.md"


@pytest.mark.verifies("SWR-TRC-010", technique="interface", polarity="nominal")
def test_the_command_can_be_mounted_by_another_one(sample: Sample, capsys: pytest.CaptureFixture[str]) -> None:
    parser = argparse.ArgumentParser()
    add_arguments(parser.add_subparsers())

    status = run(parser.parse_args(["trace", "check", "--root", str(sample.root)]))

    assert (status, capsys.readouterr().out.splitlines()[0]) == (0, "8 items: 8 verified")


@pytest.mark.verifies("SWR-TRC-010", technique="requirements_based", polarity="nominal")
def test_text_findings_begin_with_file_and_line_and_have_no_colour_in_a_pipe(sample: Sample, trace: Callable) -> None:
    line = sample.replace(SYSTEM, "The tool shall run", "The tool runs")
    sample.review()

    outcome = trace("check", "--root", sample.root)

    assert outcome.out.startswith(f"{SYSTEM}:{line}: error: [shall-count] ")
    assert "\x1b" not in outcome.out


@pytest.mark.verifies("SWR-TRC-010", technique="requirements_based", polarity="nominal")
def test_show_follows_one_item_up_and_down(sample: Sample, trace: Callable) -> None:
    outcome = trace("show", "SWR-SUP-001", "--root", sample.root)

    for part in ("[verified]", "HAZ-001 Speed", "safety/include/alive.hpp:5", "passed  AliveTest.SilenceIsReported"):
        assert part in outcome.out


@pytest.mark.parametrize(("typed", "near"), [("SWR-SUP-01", "SWR-SUP-001"), ("swr-tls", "SWR-TLS-001")])
@pytest.mark.verifies("SWR-TRC-010", technique="error_guessing", polarity="violation")
def test_an_unknown_id_is_answered_with_the_nearest_ones(sample: Sample, trace: Callable, typed: str, near: str) -> None:
    outcome = trace("show", typed, "--root", sample.root)

    assert outcome.status == 2
    assert outcome.err.count("\n") == 1
    assert near in outcome.err


@pytest.mark.verifies("SWR-TRC-009", technique="error_guessing", polarity="violation")
def test_a_missing_folder_is_named_in_one_line(sample: Sample, trace: Callable, tmp_path: Path) -> None:
    no_project = trace("check", "--root", tmp_path / "nowhere")
    no_such_evidence = trace("check", "--root", sample.root, "--evidence", tmp_path / "gone", "--allow-missing")
    shutil.rmtree(sample.root / "build")
    no_evidence = trace("check", "--root", sample.root)
    (sample.root / "requirements" / "schema" / "items.toml").write_text("schema = ")
    no_schema = trace("check", "--root", sample.root)

    for outcome, named in ((no_project, "nowhere"), (no_such_evidence, "gone"), (no_evidence, "evidence"), (no_schema, "items.toml")):
        assert (outcome.status, outcome.out, outcome.err.count("\n")) == (2, "", 1)
        assert named in outcome.err


@pytest.mark.verifies("SWR-TRC-008", technique="requirements_based", polarity="nominal")
def test_a_review_makes_a_suspect_link_good_again(sample: Sample, trace: Callable) -> None:
    sample.replace(SYSTEM, "The tool shall run offline.", "The tool shall run alone.")
    before = trace("check", "--root", sample.root, "--output", "json")

    review = trace("review", "SYS-003", "--by", "Somebody Else", "--root", sample.root)

    after = trace("check", "--root", sample.root, "--output", "json")
    assert (before.rules, review.status, after.rules) == ({"suspect-link"}, 0, set())
    lines = (sample.root / "requirements" / "trace.lock").read_text().splitlines()
    assert [line.split()[0::2][:2] for line in lines if line.endswith("Somebody Else")] == [["SWR-TLS-001", "SYS-003"], ["SYS-003", "STK-001"]]


@pytest.mark.verifies("SWR-TRC-008", technique="fault_injection", polarity="violation")
def test_a_change_of_either_end_makes_the_link_suspect(sample: Sample, trace: Callable) -> None:
    sample.replace(SYSTEM, "The kernel shall supervise time.", "The kernel shall supervise everything.")

    outcome = trace("check", "--root", sample.root, "--output", "json")

    suspects = {finding["item"] for finding in outcome.content["findings"]}
    assert (outcome.status, outcome.rules, suspects) == (1, {"suspect-link"}, {"SYS-001", "SWR-SUP-001", "SWR-SUP-002"})


@pytest.mark.verifies("SWR-TRC-008", technique="boundary_values", polarity="violation")
def test_a_rationale_may_be_mended_without_a_review(sample: Sample, trace: Callable) -> None:
    text = (sample.root / SYSTEM).read_text()
    (sample.root / SYSTEM).write_text(text.replace("- Rationale: It is needed.", "- Rationale: It is needed badly."))

    assert trace("check", "--root", sample.root).status == 0


@pytest.mark.parametrize("arguments", [(), ("--all", "SYS-001"), ("SYS-999",)])
@pytest.mark.verifies("SWR-TRC-008", technique="error_guessing", polarity="violation")
def test_a_review_of_nothing_or_of_the_unknown_changes_nothing(sample: Sample, trace: Callable, arguments: tuple[str, ...]) -> None:
    lock = (sample.root / "requirements" / "trace.lock").read_bytes()

    outcome = trace("review", *arguments, "--by", "Somebody", "--root", sample.root)

    assert (outcome.status, outcome.err.count("\n")) == (2, 1)
    assert (sample.root / "requirements" / "trace.lock").read_bytes() == lock


@pytest.mark.parametrize("name", ["a\nb", "a\tb", "a\u2028b", "a\udcffb"], ids=["line end", "tab", "line separator", "no text"])
@pytest.mark.verifies("SWR-TRC-008", technique="error_guessing", polarity="violation")
def test_a_reviewer_whose_name_would_break_the_record_is_refused(sample: Sample, trace: Callable, name: str) -> None:
    (sample.root / "requirements" / "trace.lock").unlink()

    outcome = trace("review", "--all", "--by", name, "--root", sample.root)

    assert (outcome.status, outcome.err.count("\n")) == (2, 1)
    assert not (sample.root / "requirements" / "trace.lock").exists()


JSON_ACTIONS = (("check",), ("check", "--allow-missing"), ("report",), ("show", "SYS-001"), ("show", "SYS-001", "--history"), ("query", "level=SWR"),
                ("query", "level=SWR and sil=QM"), ("impact", "HEAD"), ("bundle", "--out", "bundle.tar"), ("verify", "bundle.tar"))  # fmt: skip


@pytest.mark.verifies("SWR-TRC-108", technique="interface", polarity="nominal")
def test_json_stands_alone_on_standard_output(sample: Sample) -> None:
    """Each run is a new process, and there are two runs, because the first may print additional messages."""
    start_history(sample.root)
    for words in JSON_ACTIONS:
        for _ in range(2):
            root = () if words[0] == "verify" else ("--root", ".")
            command = [sys.executable, "-P", "-m", "mamori_trace", *words, *root, "--json"]
            done = subprocess.run(command, cwd=sample.root, capture_output=True, text=True, check=False, timeout=120)
            assert json.loads(done.stdout), (words, done.stderr)
