# SPDX-License-Identifier: Apache-2.0
# Goal: the step "Python checks" reports the findings of ruff and mypy with their locations, and fails. Method: the rules of the project,
# applied to a small tree of the same layout.
from __future__ import annotations

import importlib.util
import shutil
from importlib.machinery import ModuleSpec
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT, Project
from mamori_tools.host.steps import Context, Tier, run_steps
from verification.checks import check_python
from verification.plan import gate

CLEAN = "from __future__ import annotations\n\n\ndef double(value: int) -> int:\n    return 2 * value\n"
USE = "from mamori_trace.numbers import double\n\nFOUR = double(2)\n"


@pytest.fixture
def root(tmp_path: Path) -> Path:
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    for name in ("trace/mamori_trace", "tools/mamori_tools", "verification", "examples"):
        (tmp_path / name).mkdir(parents=True)
    for name in ("trace/mamori_trace", "tools/mamori_tools", "verification"):
        (tmp_path / name / "__init__.py").touch()
    (tmp_path / "examples" / "a.py").touch()
    (tmp_path / "conftest.py").touch()
    (tmp_path / "trace" / "mamori_trace" / "numbers.py").write_text(CLEAN)
    (tmp_path / "verification" / "use.py").write_text(USE)
    return tmp_path


@pytest.mark.verifies("SWR-CLI-006", technique="interface")
def test_a_clean_tree_passes_again_and_again(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert [check_python.check(root), check_python.check(root)] == [0, 0]
    assert "no issues found in 7 source files" in capsys.readouterr().out


@pytest.mark.verifies("SWR-CLI-006", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(
    ("file", "old", "new", "finding"),
    [
        ("trace/mamori_trace/numbers.py", "annotations\n\n", "annotations\n\nimport os\n", "trace/mamori_trace/numbers.py:3:8"),
        ("verification/use.py", "double(2)", 'double("2")', 'verification/use.py:3: error: Argument 1 to "double" has incompatible type'),
        ("trace/mamori_trace/numbers.py", "value: int", "value", "trace/mamori_trace/numbers.py:4: error: Function is missing a type annotation"),
    ],
    ids=["unused import", "wrong type", "no type"],
)
def test_a_finding_fails_the_step_and_is_in_its_log(root: Path, file: str, old: str, new: str, finding: str) -> None:
    (root / file).write_text((root / file).read_text().replace(old, new))

    [outcome] = run_steps([gate.PYTHON_CHECKS], Context(Project(root), 1))

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
    assert gate.PYTHON_CHECKS in gate.list_test_steps(Project(ROOT), lambda *_: None, tier)
