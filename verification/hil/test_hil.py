# SPDX-License-Identifier: Apache-2.0
# Goal: the arm of three processes has the verdicts of virtual time, and each process can be killed. Method: `./mamori hil` itself, once;
# its hil.json is the oracle. A disturbed host makes a case inconclusive: skipped with the figure.
from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mamori_tools.host.exit_status import EXIT_MISSING
from mamori_tools.host.project import ROOT, Project

SHORT = ("--fault", "corruption_drive", "--fault", "none", "--kills", "1")
LONG = ("--scenarios", "100", "--kills", "60")
Record = Callable[[str, object], None]


def run_hil(words: tuple[str, ...], out: Path) -> list[dict[str, Any]]:
    """@return the cases. Skips if this host cannot run them."""
    command = [sys.executable, "-P", "-m", "mamori_tools.command", "hil", *words, "--out", str(out)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    print(done.stdout)
    if done.returncode == EXIT_MISSING:
        pytest.skip(f"verdict=not-shown: {done.stderr.strip()}")
    assert (out / "hil.json").is_file(), done.stdout + done.stderr
    cases: list[dict[str, Any]] = json.loads((out / "hil.json").read_text(encoding="utf-8"))["cases"]
    return cases


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("hil") / "run"


@pytest.fixture(scope="module")
def short_run(folder: Path) -> list[dict[str, Any]]:
    """All short tests share one call of the command."""
    return run_hil(SHORT, folder)


def check(cases: list[dict[str, Any]], record_property: Record) -> None:
    """Fails with the failed checks. Skips if the host disturbed all cases."""
    failed = [f"{case['id']}: {check['name']}: {check['measured']} (expected {check['wanted']})"
              for case in cases if case["verdict"] == "failed" for check in case["checks"] if not check["passed"]]  # fmt: skip
    differing = [case["id"] for case in cases if case["verdict"] == "passed" and case["virtual"] not in (None, "passed")]
    assert not failed and not differing, "\n".join([*failed, *differing])
    figures = [f"{case['id']}: {case['figure']}" for case in cases if case["verdict"] == "inconclusive"]
    record_property("verdict", "inconclusive" if figures else "passed")
    if figures:
        record_property("figure", "; ".join(figures))
    if len(figures) == len(cases):
        pytest.skip(f"verdict=inconclusive: {figures[0]}")


@pytest.mark.verifies("SWR-HIL-014", technique="back_to_back")
def test_the_motion_has_the_verdict_of_virtual_time(short_run: list[dict[str, Any]], record_property: Record) -> None:
    check([case for case in short_run if case["id"] == "none-1"], record_property)


@pytest.mark.verifies("SWR-HIL-003", technique="fault_injection", polarity="violation")
def test_damaged_messages_to_the_plant_close_it(short_run: list[dict[str, Any]], record_property: Record) -> None:
    check([case for case in short_run if case["error"] == "corruption"], record_property)


@pytest.mark.verifies("SWR-HIL-013", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("process", ["kernel", "controller", "plant"])
def test_the_end_of_a_process_leaves_the_arm_safe(process: str, short_run: list[dict[str, Any]], record_property: Record) -> None:
    check([case for case in short_run if case["kill"] == process], record_property)


@pytest.mark.verifies("SWR-HIL-009", technique="interface")
def test_the_log_of_a_run_has_the_messages_of_all_links(short_run: list[dict[str, Any]], folder: Path) -> None:
    assert short_run
    log = (folder / "none-1" / "lcm.log").read_bytes()
    assert min(log.count(channel) for channel in (b"ARM_DEVICES", b"ARM_DRIVES", b"ARM_STATE", b"ARM_COMMAND")) > 1000


@pytest.mark.verifies("SWR-HIL-015", technique="back_to_back")
def test_two_replays_of_a_log_send_the_same_messages(short_run: list[dict[str, Any]], folder: Path, tmp_path: Path) -> None:
    assert short_run
    project = Project(ROOT)
    results = []
    for name in ("first", "second"):
        (tmp_path / name).mkdir()
        command = [str(project.safe_arm.with_name("hil_kernel")), "--replay", str(folder / "none-1" / "lcm.log"), "--frames", "2700",
                   "--model", str(project.model), "--motion", str(folder / "motion.txt"), "--out", str(tmp_path / name)]  # fmt: skip
        subprocess.run(command, check=True)
        results.append(json.loads((tmp_path / name / "replay.json").read_text(encoding="utf-8")))

    assert results[0] == results[1]
    assert results[0]["sent"] == 2700
    # A window that the host delayed changes the recorded outputs of all later frames, not the replayed ones.
    assert results[0]["equal"] > 0, results[0]


# No `verifies`: the CI gate does not run this test, so its result would be missing.
@pytest.mark.long
def test_all_cases_have_the_verdict_of_virtual_time(tmp_path: Path, record_property: Record) -> None:
    check(run_hil(LONG, tmp_path / "run"), record_property)
