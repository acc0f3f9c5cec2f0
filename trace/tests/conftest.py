# SPDX-License-Identifier: Apache-2.0
"""Fixtures of the trace tests: a small clean project in a fresh folder, and a way to run the command on it."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parent))  # pytest's importlib mode does not add the folder of the tests

import trace_sample  # noqa: E402
from mamori.trace.command import main  # noqa: E402


@dataclass
class Outcome:
    """What one run of the command gave."""

    status: int
    out: str
    err: str

    @property
    def content(self) -> dict[str, Any]:
        return json.loads(self.out)

    @property
    def rules(self) -> set[str]:
        return {finding["rule"] for finding in self.content["findings"]}

    def get_verdict(self, item: str) -> str:
        return next(row["verdict"] for row in self.content["items"] if row["id"] == item)


@pytest.fixture
def sample(tmp_path: Path) -> trace_sample.Sample:
    """A clean project: no rule finds anything."""
    return trace_sample.make_sample(tmp_path / "project")


@pytest.fixture
def trace(capsys: pytest.CaptureFixture[str]) -> Callable[..., Outcome]:
    """Runs `mamori trace ...` in this process."""

    def run(*arguments: object) -> Outcome:
        status = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return Outcome(status, captured.out, captured.err)

    return run
