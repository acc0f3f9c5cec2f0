# SPDX-License-Identifier: Apache-2.0
# Goal: the cost of a check grows at most in proportion to the project; no file is read twice, and an unchanged project is not read.
# Method: generated projects of two sizes; counted calls, opened files and bytes, which do not depend on host load.
from __future__ import annotations

import collections
import sys
import tracemalloc
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from mamori_trace.cache import inputs, outcome, state
from mamori_trace.command import main
from verification.trace_bench.large_project import Plan, write_native

SMALL, TWICE = 400, 800
MEASURED = 2_000
PEAK_BYTES_EACH = 5_000
PEAK_BYTES_FIXED = 2_000_000
REPORT_BYTES_EACH = 2_000
REPORT_BYTES_FIXED = 500_000
CALLS_EACH = 600
OPENS_MAX = 2
"""Readings of one file: both the C++ and the script reader may open it."""


@pytest.fixture(scope="module")
def projects(tmp_path_factory: pytest.TempPathFactory) -> dict[int, Path]:
    base = tmp_path_factory.mktemp("scale")
    for count in (SMALL, TWICE, MEASURED):
        write_native(Plan(count), base / str(count))
    return {count: base / str(count) for count in (SMALL, TWICE, MEASURED)}


def count_calls(words: list[str]) -> int:
    """Function calls of a check, including C functions, after its modules are loaded."""
    count = 0

    def take(_frame: FrameType, event: str, _argument: Any) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    assert main(words) == 0
    sys.setprofile(take)
    try:
        assert main(words) == 0
    finally:
        sys.setprofile(None)
    return count


@pytest.mark.verifies("SWR-TRC-093")
def test_work_grows_no_faster_than_the_project(projects: dict[int, Path], capsys: pytest.CaptureFixture[str]) -> None:
    small = count_calls(["check", "--root", str(projects[SMALL])])
    twice = count_calls(["check", "--root", str(projects[TWICE])])

    assert twice <= 2 * small
    assert twice <= CALLS_EACH * TWICE
    assert f"{TWICE} verified" in capsys.readouterr().out


@pytest.mark.verifies("SWR-TRC-093")
def test_no_file_is_read_again_and_again(
    projects: dict[int, Path], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    opened: collections.Counter[str] = collections.Counter()
    watch = inputs.start()
    take = watch.take

    def count(event: str, arguments: tuple[Any, ...]) -> None:
        opened.update([str(arguments[0])] if event == "open" else [])
        take(event, arguments)

    monkeypatch.setattr(watch, "take", count)
    try:
        assert main(["check", "--root", str(projects[SMALL])]) == 0
    finally:
        inputs.stop()

    inside = {name: count for name, count in opened.items() if name.startswith(str(projects[SMALL]))}
    plan = Plan(SMALL)
    assert len(inside) > len(plan.sources) + len(plan.tests)
    assert {name: count for name, count in inside.items() if count > OPENS_MAX} == {}


@pytest.mark.verifies("SWR-TRC-093")
@pytest.mark.parametrize("output", ["text", "json"])
def test_unchanged_project_is_not_read(
    projects: dict[int, Path], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], output: str
) -> None:
    monkeypatch.setattr(state, "RACY_NS", -(10**15))
    words = ["check", "--output", output, "--root", str(projects[SMALL])]
    runs: list[int] = []

    def run() -> int:
        runs.append(1)
        return main(words)

    assert outcome.run_kept(words, run) == 0
    first = capsys.readouterr().out
    watch = inputs.start()
    try:
        assert outcome.run_kept(words, run) == 0
    finally:
        inputs.stop()
    assert capsys.readouterr().out == first
    assert len(runs) == 1, "a reader spoils the cache: see docs/design/trace.md#cache"
    assert {Path(name).parent.name for name in watch.files} == {state.FOLDER_NAME}


@pytest.mark.verifies("SWR-TRC-093")
def test_memory_is_bounded_by_the_size(projects: dict[int, Path], capsys: pytest.CaptureFixture[str]) -> None:
    words = ["check", "--root", str(projects[MEASURED])]
    main(words)
    tracemalloc.start()
    try:
        assert main(words) == 0
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()

    assert peak <= PEAK_BYTES_FIXED + PEAK_BYTES_EACH * MEASURED


@pytest.mark.verifies("SWR-TRC-093")
def test_report_is_bounded_by_the_size(projects: dict[int, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    report = tmp_path / "index.html"

    assert main(["report", "--root", str(projects[MEASURED]), "--out", str(report)]) == 0
    assert report.stat().st_size <= REPORT_BYTES_FIXED + REPORT_BYTES_EACH * MEASURED
