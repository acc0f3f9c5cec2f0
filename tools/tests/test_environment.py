# SPDX-License-Identifier: Apache-2.0
# Goal: the record of the environment is complete and names commit, host and tools.
from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from mamori_tools.host.environment import write_environment
from mamori_tools.host.project import ROOT, Project


@pytest.mark.verifies("SWR-CLI-009")
def test_record_has_every_field_of_the_contract(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MAMORI_PACKAGES", "bash no-such-package")

    path = write_environment(Project(tmp_path), ["./mamori", "test"])

    record = json.loads(path.read_text(encoding="utf-8"))
    fields = re.search(r"`evidence/environment.json`: `(.*?)`", (ROOT / "docs/design/trace.md").read_text(), re.DOTALL)
    assert fields is not None
    assert set(re.findall(r'"(\w+)"', fields[1])) == set(record)
    assert record["command"] == "./mamori test"
    assert record["commit"] == "unknown"  # an empty folder is not a clone
    assert record["compilers"]["g++"].startswith("g++")
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\+00:00", record["date_utc"])
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.verifies("SWR-CLI-009", technique="interface")
def test_record_names_installed_packages_with_their_versions(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MAMORI_PACKAGES", "bash dpkg")

    record = json.loads(write_environment(Project(tmp_path), ["x"]).read_text(encoding="utf-8"))

    assert set(record["packages"]) == {"bash", "dpkg"}
    assert all(re.match(r"\d", version) for version in record["packages"].values())
