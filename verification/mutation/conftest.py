# SPDX-License-Identifier: Apache-2.0
"""The weak layer without changes, and its complete run."""

from __future__ import annotations

from pathlib import Path

import pytest

from verification.mutation.run import Report
from verification.mutation.sources import Sources
from verification.tests.support.weak_layer import make_sources, run_all


@pytest.fixture
def sources(tmp_path: Path) -> Sources:
    return make_sources(tmp_path)


@pytest.fixture(scope="session")
def weak(tmp_path_factory: pytest.TempPathFactory) -> Report:
    """The complete run of that project."""
    return run_all(make_sources(tmp_path_factory.mktemp("weak")))
