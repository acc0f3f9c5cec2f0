# SPDX-License-Identifier: Apache-2.0
# Goal: the marker `verifies` writes requirement, technique and polarity to the result; a misspelt marker stops the run.
from __future__ import annotations

import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT


def run_pytest(folder: Path, marks: str) -> subprocess.CompletedProcess[str]:
    shutil.copy(ROOT / "conftest.py", folder)
    (folder / "test_it.py").write_text(f"import pytest\n\n\n{marks}\ndef test_it():\n    pass\n", encoding="utf-8")
    return subprocess.run(
        [sys.executable, "-P", "-m", "pytest", "-q", "-p", "no:cacheprovider", f"--rootdir={folder}", "--junitxml=result.xml"],
        cwd=folder, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL,
    )  # fmt: skip


def read_properties(folder: Path) -> dict[str, str]:
    case = ElementTree.parse(folder / "result.xml").find(".//testcase")
    assert case is not None
    return {element.attrib["name"]: element.attrib["value"] for element in case.iter("property")}


@pytest.mark.verifies("SWR-CLI-010")
def test_marker_becomes_three_properties(tmp_path: Path) -> None:
    mark = '@pytest.mark.verifies("SWR-X-001", technique="boundary_values", polarity="violation")'

    assert run_pytest(tmp_path, mark).returncode == 0
    assert read_properties(tmp_path) == {
        "requirement": "SWR-X-001", "technique": "boundary_values", "polarity": "violation"
    }  # fmt: skip


@pytest.mark.verifies("SWR-CLI-010", technique="interface")
def test_technique_and_polarity_have_defaults(tmp_path: Path) -> None:
    assert run_pytest(tmp_path, '@pytest.mark.verifies("SWR-X-001")').returncode == 0
    assert read_properties(tmp_path) == {
        "requirement": "SWR-X-001", "technique": "requirements_based", "polarity": "nominal"
    }  # fmt: skip


@pytest.mark.parametrize(
    ("marks", "reason"),
    [
        ('@pytest.mark.verifies("SWR-X-001", technique="guess")', "'guess' is none of"),
        ('@pytest.mark.verifies("SWR-X-001", polarity="good")', "'good' is none of"),
        ('@pytest.mark.verifies("SWR-X-001")\n@pytest.mark.verifies("SWR-X-002")', "a test verifies one requirement"),
    ],
)
@pytest.mark.verifies("SWR-CLI-010", technique="error_guessing", polarity="violation")
def test_misspelt_marker_stops_the_run(tmp_path: Path, marks: str, reason: str) -> None:
    done = run_pytest(tmp_path, marks)

    assert done.returncode != 0
    assert reason in done.stdout + done.stderr
