# SPDX-License-Identifier: Apache-2.0
"""`mamori campaign`. Method: the command with a small program that replaces the arm; see campaign_bench."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Generator, Sequence
from pathlib import Path

import pytest
from campaign_bench import Bench

from mamori_tools.campaign import runner
from mamori_tools.campaign.arm.subject import SUBJECT as ARM
from mamori_tools.campaign.case import Case, Evaluation
from mamori_tools.campaign.work import Outcome, Work, run_local
from mamori_tools.command.main import main
from mamori_tools.host.project import Project


@pytest.fixture
def bench(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Bench:
    monkeypatch.delenv("MAMORI_COMMIT", raising=False)
    return Bench(tmp_path)


def call(bench: Bench, *options: str) -> int:
    return main(bench.make_command(*options)[4:])


@pytest.mark.verifies("SWR-CMP-012")
def test_progress_goes_to_standard_error_and_the_result_to_standard_output(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(bench) == 0
    shown = capsys.readouterr()

    assert [line.split()[:2] for line in shown.err.splitlines()] == [[f"[{number}/3]", "passed"] for number in (1, 2, 3)]
    assert shown.out.splitlines()[-1] == "3 passed, 0 failed, 0 inconclusive"
    assert shown.out.count("\n") == 3


@pytest.mark.verifies("SWR-CMP-012", technique="interface")
def test_the_result_as_json_is_all_of_standard_output(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(bench, "--json", "--scenario", "message_late", "--instants", "1") == 0
    content = json.loads(capsys.readouterr().out)

    assert content["schema"] == "mamori.campaign_summary/1"
    assert (content["passed"], content["failed"], content["inconclusive"], content["kept"]) == (1, 0, 0, 0)
    assert content["cases"] == [{"id": "message_late-1", "verdict": "passed", "failure": ""}]


@pytest.mark.verifies("SWR-CMP-012", technique="fault_injection", polarity="violation")
def test_a_failed_case_gives_status_1_and_the_command_that_runs_it_again(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.write_plan(8)

    assert call(bench) == 1
    shown = capsys.readouterr().out
    assert "message_late-1: run: wanted a whole run, was program ended with exit status 1" in shown
    assert f"at commit none: ./mamori campaign {bench.plan} --replay message_late-1" in shown
    assert shown.splitlines()[-1] == "1 passed, 2 failed, 0 inconclusive"


@pytest.mark.verifies("SWR-CMP-012")
def test_an_inconclusive_case_is_counted_and_does_not_change_the_status(bench: Bench, capsys: pytest.CaptureFixture[str],
                                                                        monkeypatch: pytest.MonkeyPatch) -> None:
    class Undecided(type(ARM)):  # type: ignore[misc]
        def evaluate(self, case: Case, folder: Path, problem: str) -> Evaluation:
            return Evaluation({}, (), "inconclusive")

    monkeypatch.setattr(runner, "load_subject", lambda name: Undecided())

    assert call(bench) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "0 passed, 0 failed, 3 inconclusive"
    assert [case["verdict"] for case in bench.read_json()["cases"]] == ["inconclusive"] * 3
    cases = bench.read_testcases()
    assert all(case.find("skipped") is not None and case.find("failure") is None for case in cases)
    assert all({"verdict": "inconclusive"}.items() <= {each.get("name"): each.get("value") for each in case.iter("property")}.items()
               for case in cases)


@pytest.mark.verifies("SWR-CMP-012")
def test_the_scenarios_are_listed_without_a_run(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(bench, "--list") == 0
    assert capsys.readouterr().out == f"{'none':<24}  1 x  No fault\n{'message_late':<24}  2 x  Late & <quoted>\n"
    assert call(bench, "--list", "--json", "--instants", "1") == 0
    assert [row["cases"] for row in json.loads(capsys.readouterr().out)] == [1, 1]
    assert not bench.evidence.exists()


@pytest.mark.parametrize(("options", "sentence"), [
    (("--scenario", "nome"), "unknown scenario 'nome'"),
    (("--instants", "3"), "3 instants per scenario; the plan has 2"),
    (("--instants", "0"), "argument --instants: '0' is "),
    (("--timeout", "0"), "time-out of 0 s; write a number above 0"),
    (("--program", "/nowhere/safe_arm"), "/nowhere/safe_arm: no program that can be run; build it first (./mamori build)"),
    (("--model", "/nowhere/model.yaml"), "/nowhere/model.yaml: model file not found"),
    (("--out", "/proc/none"), "evidence cannot be written"),
    (("--replay", "none-2"), "unknown case 'none-2'; "),
    (("--dask", "tcp://127.0.0.1:8786", "--jobs", "2"), "--jobs: the cluster decides how many cases run at a time"),
])  # fmt: skip
@pytest.mark.verifies("SWR-CMP-002", technique="equivalence_classes", polarity="violation")
def test_bad_input_gives_one_line_and_status_2(bench: Bench, capsys: pytest.CaptureFixture[str], options: tuple[str, ...],
                                               sentence: str) -> None:
    assert call(bench, *options) == 2
    shown = capsys.readouterr()
    assert (shown.out, shown.err.count("\n")) == ("", 1)
    assert sentence in shown.err
    assert not (bench.evidence / "campaign/results/key.json").exists()


@pytest.mark.verifies("SWR-CMP-002", technique="interface", polarity="violation")
def test_a_plan_of_another_schema_is_rejected_with_file_and_line(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.plan.write_text(bench.plan.read_text().replace("fault_plan/1", "fault_plan/2"))

    assert call(bench) == 2
    assert capsys.readouterr().err == f"mamori: {bench.plan}:1: schema: 'mamori.fault_plan/2', this tool reads mamori.fault_plan/1\n"


@pytest.mark.verifies("SWR-CMP-012", technique="interface")
def test_program_model_and_motion_of_the_checkout_are_the_default(bench: Bench, capsys: pytest.CaptureFixture[str],
                                                                  monkeypatch: pytest.MonkeyPatch) -> None:
    from mamori_tools.campaign import command

    monkeypatch.setattr(command, "ROOT", bench.folder)

    assert main(["campaign", str(bench.plan)]) == 2
    assert capsys.readouterr().err.startswith(f"mamori: {Project(bench.folder).safe_arm}: no program that can be run; build it first (./mamori build)")


@pytest.mark.verifies("SWR-CMP-012", technique="interface")
def test_the_large_libraries_are_imported_only_when_a_campaign_runs() -> None:
    code = "import sys; import mamori_tools.campaign.command; print({'pyarrow', 'distributed', 'numpy'} & set(sys.modules))"

    assert subprocess.run([sys.executable, "-P", "-c", code], capture_output=True, text=True, check=True).stdout == "set()\n"


@pytest.mark.verifies("SWR-CMP-008")
@pytest.mark.parametrize(("jobs_max", "at_once"), [(1, 1), (2, 2), (3, 3), (4, 3), (None, 3)])
def test_a_subject_bounds_the_cases_that_run_at_the_same_time(bench: Bench, monkeypatch: pytest.MonkeyPatch, jobs_max: int | None,
                                                             at_once: int) -> None:
    class Bounded(type(ARM)):  # type: ignore[misc]
        pass

    seen: list[int] = []

    def run_and_note(works: Sequence[Work], root: Path, jobs: int) -> Generator[Outcome]:
        seen.append(jobs)
        return run_local(works, root, jobs)

    Bounded.jobs_max = jobs_max
    monkeypatch.setattr(runner, "load_subject", lambda name: Bounded())
    monkeypatch.setattr(runner, "run_local", run_and_note)

    assert call(bench, "--jobs", "3") == 0
    assert seen == [at_once]


@pytest.mark.verifies("SWR-CMP-013")
def test_a_replay_runs_one_case_and_compares_it_with_the_stored_result(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(bench, "--replay", "message_late-2") == 0
    assert capsys.readouterr().out.splitlines()[-1] == "passed; no stored result of the same campaign to compare with"
    assert call(bench, "--scenario", "message_late") == 0  # a replay does not need an equal selection
    capsys.readouterr()
    before = bench.list_stored()

    assert call(bench, "--replay", "message_late-2") == 0
    lines = capsys.readouterr().out.splitlines()
    assert (lines[0], lines[-1]) == ("message_late-2: Late & <quoted>", "passed; equals the stored result")
    assert any(line.startswith("  passed  final state") and line.endswith("expected Safe, measured Safe") for line in lines)
    assert bench.list_stored() == before
    assert [path.name for path in (bench.evidence / "campaign/replay").iterdir() if path.is_dir()] == ["message_late-2"]


@pytest.mark.verifies("SWR-CMP-013", technique="fault_injection", polarity="violation")
def test_a_replay_that_differs_from_the_stored_result_says_so(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    bench.write_plan(10)  # each run writes a different margin
    assert call(bench) == 0
    capsys.readouterr()

    assert call(bench, "--replay", "message_late-1", "--json") == 0
    content = json.loads(capsys.readouterr().out)
    assert (content["equals_stored"], content["case"]["verdict"]) == (False, "pass")
    bench.write_plan(8)
    assert call(bench, "--replay", "message_late-1") == 1
    assert capsys.readouterr().out.splitlines()[-1] == "failed; no stored result of the same campaign to compare with"
