# SPDX-License-Identifier: Apache-2.0
# Goal: wrong arguments and input end with status 2 and one helpful line, before anything is built or removed.
from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from mamori_tools.command import demo
from mamori_tools.command.main import main, make_parser
from mamori_tools.host import plans, session
from mamori_tools.host.environment import collect_environment, write_environment
from mamori_tools.host.full_run import FILE, read_full_run, record_full_run
from mamori_tools.host.project import RELEASE, ROOT, SANITIZED, Project
from mamori_tools.host.steps import Context, Step, Tier, run_steps
from mamori_trace.base.errors import InputError
from mamori_trace.reports.view import describe_full_run
from verification.plan import gate


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("biuld",), "build"),
        (("build", "--preste", "x"), "build has no option '--preste'; nearest: --preset"),
        (("build", "--preset", "host-relase"), "there is no preset 'host-relase'; nearest: host-release"),
        (("build", "/nowhere"), "'/nowhere' has no CMakeLists.txt"),
        (("build", "a", "b"), "build does not take 'b'"),
        (("demo", "--jobs", "0"), "'0' is not an integer of at least 1"),
        (("mutate", "--jobs", "-1"), "mutate: argument --jobs: '-1' is not an integer of at least 1"),
        (("mutate", "nothing.cpp"), "mutate: 'nothing.cpp' is no source or header of kernel, safety, ports or examples/safe_arm; ./mamori mutate --list"),
        (("demo", "--instants", "-1"), "--instants"),
        (("demo", "--instants", "1.5"), "'1.5' is not an integer of at least 1"),
        (("demo", "--motion"), "expected one argument"),
    ],
)
@pytest.mark.verifies("SWR-CLI-005", technique="boundary_values", polarity="violation")
def test_wrong_word_gives_status_2_and_one_line(
    words: tuple[str, ...], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == 2

    said = capsys.readouterr().err
    assert sentence in said
    assert said.count("\n") == 1


@pytest.mark.verifies("SWR-CLI-005")
def test_scenarios_may_be_given_in_one_go_or_one_by_one() -> None:
    arguments = make_parser().parse_args(["demo", "--scenario", "a", "b", "--scenario", "c", "--instants", "1"])

    assert (arguments.scenario, arguments.instants) == (["a", "b", "c"], 1)


@pytest.mark.verifies("SWR-CLI-011", polarity="violation")
def test_results_of_an_earlier_run_are_thrown_away(tmp_path: Path) -> None:
    project = Project(tmp_path)
    old = [Project(tmp_path, preset).junit / "old.xml" for preset in (RELEASE, SANITIZED)]
    for path in old:
        path.parent.mkdir(parents=True)
        path.write_text("<testsuite/>", encoding="utf-8")

    session.begin(project, 1, (RELEASE, SANITIZED))

    assert not any(path.exists() for path in old)
    assert project.junit.is_dir()


@pytest.mark.verifies("SWR-CLI-011")
def test_a_run_begins_with_the_record_of_its_environment(tmp_path: Path) -> None:
    session.begin(Project(tmp_path), 1, (RELEASE,))

    assert [path.name for path in Project(tmp_path).evidence.iterdir() if path.is_file()] == ["environment.json"]


@pytest.mark.verifies("SWR-CLI-006", technique="interface")
@pytest.mark.parametrize("tier", Tier)
def test_each_step_of_the_plans_is_named_once_and_needs_earlier_ones_only(tier: Tier) -> None:
    nothing = lambda context, tick, log: None  # noqa: E731
    project = Project(ROOT)
    user = Project(Path("/x"))
    for plan in (plans.demo_plan(nothing), gate.list_verify_steps(nothing), gate.list_test_steps(project, nothing, tier), plans.verify_plan(user)):
        seen: list[str] = []
        for step in plan:
            assert step.name not in seen
            assert set(step.needs) <= set(seen)
            seen.append(step.name)


def no_campaign(context: Context, tick: object, log: object) -> None:
    pass


@pytest.mark.verifies("SWR-CLI-012")
def test_the_demo_builds_the_program_of_the_example_and_runs_no_test() -> None:
    plan = {step.name: step for step in plans.demo_plan(no_campaign)}

    assert plan[plans.BUILD].commands[-1][-2:] == ("--target", "safe_arm")
    words = {word for step in plan.values() for command in step.commands for word in command}
    assert not words & {"ctest", "pytest"}
    assert {"fault campaign", "trace check", plans.REPORT} <= set(plan)


@pytest.mark.verifies("SWR-CLI-012", polarity="violation")
def test_each_step_of_the_gate_that_the_demo_leaves_out_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shown_plan, whole = plans.demo_plan(no_campaign), gate.list_test_steps(Project(ROOT), no_campaign, Tier.GATE)
    names = plans.find_not_run(shown_plan, whole)

    assert {step.name for step in shown_plan} | set(names) == {step.name for step in whole}
    assert not {step.name for step in shown_plan} & set(names)
    assert "tests host-release" in names

    demo.show_not_run(names, Context(Project(tmp_path), 1))
    shown = " ".join(capsys.readouterr().out.split())
    assert "not run (./mamori test" in shown
    assert ", ".join(names) in shown


@pytest.mark.verifies("SWR-CLI-050")
def test_the_table_of_the_manual_names_each_step_with_its_tier() -> None:
    page = (ROOT / "docs" / "manual" / "test_tiers.md").read_text(encoding="utf-8")
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in page.splitlines() if line.startswith("| ")]
    told = {row[0]: row[1] for row in rows if len(row) == 4 and row[0] != "step"}
    steps = {step.name: "default" if step.tier == Tier.GATE else f"--{step.tier.name.lower()}"
             for step in gate.list_test_steps(Project(ROOT), no_campaign, Tier.ALL)}  # fmt: skip

    assert {name: tier.strip("`") for name, tier in told.items()} == steps


@pytest.mark.verifies("SWR-CLI-050", technique="equivalence_classes")
def test_each_tier_has_all_steps_of_the_one_before() -> None:
    quick, normal, whole = ([step.name for step in gate.list_test_steps(Project(ROOT), no_campaign, tier)] for tier in Tier)

    assert set(quick) < set(normal) < set(whole)
    assert make_parser().parse_args(["test"]).tier == Tier.GATE
    assert [make_parser().parse_args(["test", option]).tier for option in ("--quick", "--all")] == [Tier.QUICK, Tier.ALL]


@pytest.mark.verifies("SWR-CLI-050", technique="error_guessing", polarity="violation")
def test_two_tiers_at_once_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["test", "--quick", "--all"]) == 2
    assert "not allowed with" in capsys.readouterr().err


@pytest.mark.verifies("SWR-CLI-050")
def test_a_whole_run_is_recorded_with_date_commit_and_steps(tmp_path: Path) -> None:
    project = Project(tmp_path)
    (tmp_path / FILE).parent.mkdir()
    write_environment(project, ["./mamori", "test", "--all"])
    assert read_full_run(tmp_path) == {}
    steps = Step("good", (("true",),)), Step("bad", (("false",),)), Step("disturbed", (("sh", "-c", "exit 4"),), inconclusive=(4,))

    outcomes = run_steps(steps, Context(project, 1))
    record_full_run(project, outcomes)

    kept = read_full_run(tmp_path)
    environment = json.loads((project.evidence / "environment.json").read_text(encoding="utf-8"))
    assert (kept["date_utc"], kept["commit"]) == (environment["date_utc"], environment["commit"])
    assert [(step["name"], step["verdict"]) for step in kept["steps"]] == [("good", "passed"), ("bad", "failed"), ("disturbed", "inconclusive")]
    assert collect_environment(project, ())["full_run"] == kept
    shown = describe_full_run(kept)
    assert (shown["date"], shown["count"], shown["failed"]) == (environment["date_utc"][:10], 3, ["bad (failed)", "disturbed (inconclusive)"])
    assert (str(outcomes[2].counts), outcomes[2].verdict) == ("0 passed, 0 failed, 1 skipped", "passed")


@pytest.mark.verifies("SWR-CLI-050", technique="error_guessing", polarity="violation")
@pytest.mark.parametrize("text", ["", "[]", '{"schema": "mamori.full_run/2"}'])
def test_a_record_that_cannot_be_read_counts_as_none(tmp_path: Path, text: str) -> None:
    path = tmp_path / FILE
    path.parent.mkdir()
    path.write_text(text, encoding="utf-8")

    assert read_full_run(tmp_path) == {}


@pytest.mark.verifies("SWR-CLI-006", technique="interface")
def test_verify_of_the_project_itself_runs_its_tests() -> None:
    names = {step.name for step in gate.list_verify_steps(no_campaign)}

    assert {"tests host-release", "tests of the host tools", "fault campaign", "trace check"} <= names


@pytest.mark.verifies("SWR-CLI-007", technique="boundary_values", polarity="violation")
def test_the_closing_lines_say_all_of_each_failed_result(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    facts = "x" * (session.FAILURE_LENGTH - len("time.late: "))
    results = f'<testsuite><testcase classname="time" name="late"><failure message="{facts}!"/></testcase></testsuite>'
    step = Step("tests", (("sh", "-c", f"echo '{results}' >{{result}}; exit 1"),), result="tests.xml")
    context = session.begin(Project(tmp_path), 1, (RELEASE,))
    outcomes = run_steps([step], context)
    capsys.readouterr()

    assert session.finish(outcomes, context) == 1

    said = capsys.readouterr().out
    assert f"tests: time.late: {facts}\nfailed: tests\n0 passed, 1 failed, 0 skipped\n" in said


@pytest.mark.parametrize(
    ("script", "verdict"),
    [(f"touch {{product}}; exit {status}", "passed") for status in (0, 1, 4)]
    + [("touch {product}; exit 2", "failed"), ("touch {product}; exit 130", "failed"), ("exit 0", "failed"), ("exit 1", "failed")],
)
@pytest.mark.verifies("SWR-CLI-006", technique="equivalence_classes", polarity="violation")
def test_a_late_machine_does_not_fail_the_timing_run_but_a_missing_result_does(script: str, verdict: str, tmp_path: Path) -> None:
    step = plans.timing_step()
    product = tmp_path / step.produces
    product.parent.mkdir(parents=True)
    command = ("sh", "-c", script.format(product=product))

    outcomes = run_steps([replace(step, commands=(command,), needs=())], Context(Project(tmp_path), 1))

    assert [outcome.verdict for outcome in outcomes] == [verdict]


@pytest.mark.verifies("SWR-CLI-006", technique="interface")
def test_the_words_of_the_timing_run_are_those_of_the_command_and_its_result_is_where_the_report_looks() -> None:
    step = plans.timing_step()
    words = step.commands[0][step.commands[0].index("timing") :]

    arguments = make_parser().parse_args([word.format(jobs=1) for word in words])

    assert (ROOT / arguments.system / "timing.toml").is_file()
    assert ROOT / step.produces == Project(ROOT).evidence / "timing" / "safe_arm" / "timing.json"


@pytest.mark.verifies("SWR-CLI-006", technique="interface")
def test_the_words_of_the_cost_step_are_those_of_the_command_and_its_result_is_where_the_report_looks() -> None:
    step = gate.cost_step()
    words = step.commands[0][step.commands[0].index("cost") :]

    arguments = make_parser().parse_args([word.format(jobs=1) for word in words])

    assert (ROOT / arguments.system / "timing.toml").is_file()
    assert (ROOT / arguments.check).is_file()
    assert ROOT / step.produces == Project(ROOT).evidence / "cost" / "safe_arm" / "cost.json"


@pytest.mark.verifies("SWR-CLI-005", technique="error_guessing", polarity="violation")
def test_report_that_could_not_be_written_is_known_before_the_work(tmp_path: Path) -> None:
    (tmp_path / "report").write_text("a file where the folder should be\n", encoding="utf-8")

    with pytest.raises(InputError, match="report: the report cannot be written there"):
        session.begin(Project(tmp_path), 1, (RELEASE,))
    assert not (tmp_path / "build").exists()


@pytest.mark.verifies("SWR-CLI-005", technique="error_guessing", polarity="violation")
def test_project_without_requirements_cannot_be_verified(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "CMakeLists.txt").write_text("project(user)\n", encoding="utf-8")

    assert main(("verify", str(tmp_path))) == 2
    assert "has no folder requirements/" in capsys.readouterr().err
