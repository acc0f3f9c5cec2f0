# SPDX-License-Identifier: Apache-2.0
"""Fixtures of the trace tests: a small clean project in a new folder, and a function that runs the command on it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path

import pytest
import trace_sample
from trace_sample import Outcome

from mamori_trace.base.errors import InputError
from mamori_trace.command import main
from mamori_trace.readers.evidence_records import list_recorded


@pytest.fixture
def sample(tmp_path: Path) -> trace_sample.Sample:
    """A clean project without findings."""
    return trace_sample.make_sample(tmp_path / "project")


@pytest.fixture
def trace(capsys: pytest.CaptureFixture[str]) -> Callable[..., Outcome]:
    """Runs `mamori trace ...` in this process, with current records of the evidence unless `recorded` is false."""

    def run(*arguments: object, recorded: bool = True) -> Outcome:
        words = [str(argument) for argument in arguments]
        if recorded:
            _record_all(words)
        status = main(words)
        captured = capsys.readouterr()
        return Outcome(status, captured.out, captured.err)

    return run


def _record_all(words: list[str]) -> None:
    """Records as `mamori trace record` would write them after a test run."""
    with contextlib.suppress(OSError, InputError):
        root = Path(words[words.index("--root") + 1]) if "--root" in words else Path(".")
        folders = [*root.glob("build/*/evidence"), *(Path(words[at + 1]) for at, word in enumerate(words) if word == "--evidence")]
        for folder in folders:
            if folder.is_dir():
                trace_sample.record(folder)
        given = words[words.index("--results") + 1 :] if "--results" in words else []
        end = next((at for at, word in enumerate(given) if word.startswith("--")), len(given))
        for path in map(Path, given[:end]):
            folder = path if path.is_dir() else path.parent
            files = sorted({*filter(Path.is_file, folder.glob("*.xml")), *list_recorded(folder)})
            if any(path.suffix == ".xml" for path in files):
                trace_sample.record(folder, files)
