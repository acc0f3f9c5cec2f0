# SPDX-License-Identifier: Apache-2.0
# Goal: the step "Python checks" finds what ruff and mypy find, at its place in the tree, and fails then. Method: the rules of the
# project, on a small tree of the same layout.
from __future__ import annotations

import importlib.util
import shutil
from importlib.machinery import ModuleSpec
from pathlib import Path

import pytest

from mamori.verification.command import plans
from mamori.verification.command.project import ROOT, Project
from mamori.verification.command.steps import Context, Tier, run_steps
from mamori.verification.tools import check_python

CLEAN = "from __future__ import annotations\n\n\ndef double(value: int) -> int:\n    return 2 * value\n"
USE = "from mamori.trace.numbers import double\n\nFOUR = double(2)\n"


@pytest.fixture
def root(tmp_path: Path) -> Path:
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    for name in ("trace", "profiles", "verification", "examples"):
        (tmp_path / name).mkdir()
    for name in ("trace", "profiles", "verification"):
        (tmp_path / name / "__init__.py").touch()
    (tmp_path / "conftest.py").touch()
    (tmp_path / "trace" / "numbers.py").write_text(CLEAN)
    (tmp_path / "verification" / "use.py").write_text(USE)
    return tmp_path


@pytest.mark.verifies("SWR-CLI-006", technique="interface")
def test_a_clean_tree_passes_again_and_again(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (root / check_python.PACKAGE).mkdir(parents=True)
    (root / check_python.PACKAGE / "trace").symlink_to("nowhere")  # as after a change of the layout

    assert [check_python.check(root), check_python.check(root)] == [0, 0]
    assert "no issues found in 8 source files" in capsys.readouterr().out


@pytest.mark.verifies("SWR-CLI-006", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("file", "old", "new", "finding"),
    [
        ("trace/numbers.py", "annotations\n\n", "annotations\n\nimport os\n", "trace/numbers.py:3:8"),
        ("verification/use.py", "double(2)", 'double("2")', 'verification/use.py:3: error: Argument 1 to "double" has incompatible type'),
        ("trace/numbers.py", "value: int", "value", "trace/numbers.py:4: error: Function is missing a type annotation"),
    ],
    ids=["unused import", "wrong type", "no type"],
)
def test_a_finding_fails_the_step_and_is_in_its_log(root: Path, file: str, old: str, new: str, finding: str) -> None:
    (root / file).write_text((root / file).read_text().replace(old, new))

    [outcome] = run_steps([plans.PYTHON_CHECKS], Context(Project(root), 1))

    assert outcome.verdict == "failed"
    assert finding in outcome.log.read_text()


@pytest.mark.verifies("SWR-CLI-006", technique="fault_injection", polarity="violation")
def test_a_missing_tool_is_one_line(root: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    real = importlib.util.find_spec

    def find(name: str) -> ModuleSpec | None:
        return None if name == "mypy" else real(name)

    monkeypatch.setattr(importlib.util, "find_spec", find)
    assert check_python.check(root) == 3

    shown = capsys.readouterr()
    assert (shown.out, shown.err) == ("", "Python checks: not installed: mypy; run ./mamori test, which installs the test packages\n")


@pytest.mark.verifies("SWR-CLI-006", technique="interface")
@pytest.mark.parametrize("tier", Tier)
def test_the_step_is_in_the_plan_of_every_test_run(tier: Tier) -> None:
    assert plans.PYTHON_CHECKS in plans.test_plan(Project(ROOT), lambda *_: None, tier)
