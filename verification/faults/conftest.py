# SPDX-License-Identifier: Apache-2.0
"""The build whose programs the real-time tests run: `--preset NAME`."""

from __future__ import annotations

import pytest

from mamori_tools.host.project import RELEASE, ROOT, Project


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--preset", default=RELEASE, help="preset of the build whose programs run")


@pytest.fixture(scope="session")
def project(request: pytest.FixtureRequest) -> Project:
    return Project(ROOT, request.config.getoption("--preset"))
