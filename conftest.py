# SPDX-License-Identifier: Apache-2.0
"""Writes into a pytest result which requirement the test verifies, and how (docs/design/trace.md#evidence-files).

    @pytest.mark.verifies("SWR-TRC-001", technique="boundary_values", polarity="violation")

@satisfies SWR-CLI-010      Design: docs/design/launcher.md#python-tests
"""

from __future__ import annotations

import contextlib
from pathlib import Path

import pytest

from mamori_trace.base.errors import MissingError
from mamori_trace.base.project_lock import hold_lock

TECHNIQUES = ("requirements_based", "boundary_values", "equivalence_classes", "fault_injection", "state_transition",
              "error_guessing", "interface", "back_to_back")  # fmt: skip
POLARITIES = ("nominal", "violation")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "long: only `./mamori test --all` runs the test")
    config.addinivalue_line(
        "markers",
        "verifies(requirement, technique='requirements_based', polarity='nominal'): the requirement that the test verifies",
    )
    # Tests write to their checkout: parallel workers inherit one lock. While another command runs, the tests run without the lock.
    stack = contextlib.ExitStack()
    with contextlib.suppress(MissingError, OSError):
        stack.enter_context(hold_lock(Path(__file__).resolve().parent, "pytest"))
    config.add_cleanup(stack.close)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        marks = list(item.iter_markers("verifies"))
        if len(marks) > 1:
            raise pytest.UsageError(f"{item.nodeid}: a test verifies one requirement, this one names {len(marks)}")
        for mark in marks:
            item.user_properties.extend(_make_properties(item.nodeid, *mark.args, **mark.kwargs))


def _make_properties(
    test: str, requirement: str, technique: str = "requirements_based", polarity: str = "nominal"
) -> list[tuple[str, object]]:
    for value, known in ((technique, TECHNIQUES), (polarity, POLARITIES)):
        if value not in known:
            raise pytest.UsageError(f"{test}: '{value}' is none of: {', '.join(known)}")
    return [("requirement", requirement), ("technique", technique), ("polarity", polarity)]
