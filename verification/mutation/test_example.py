# SPDX-License-Identifier: Apache-2.0
# Goal: the campaign of an example and its tests try each mutant, a stopped run continues, and the gate does not depend on the example.
# Method: the weak layer with a program and a campaign of two cases; the plan of the example arm with a program that only fails.
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from mamori_trace.base.errors import InputError
from verification.mutation import command, workbench
from verification.mutation.campaign import Campaign, Run
from verification.mutation.command import Request, choose_files, describe_campaign, mutate, run_layers
from verification.mutation.journal import Journal
from verification.mutation.operators import Mutant
from verification.mutation.run import Plan, Report, Selection, make_plan
from verification.mutation.score import Counts
from verification.mutation.sources import ALL_LAYERS, EXAMPLE, LAYERS, PLAN, PROGRAM_UNIT, Sources, Unit, get_layer, list_files, localise
from verification.mutation.trial import BY_CAMPAIGN, BY_COMPILER, KILLED, SURVIVED, Result
from verification.tests.support.weak_layer import HEADER, LIMIT_LINE, SOURCE, find, run_all

MAIN = """\
#include "limit.hpp"
int main(int, char** words) { return words[1][0] == 'a' && is_allowed(10) ? 3 : 0; }
"""


class SmallCampaign:
    """The case `a-1` is the check of the limit that the test lacks."""

    names = ("a-1", "b-1")
    ran: list[str]

    def __init__(self, *_: object) -> None:
        SmallCampaign.ran = []

    def run(self, name: str, program: Path, _: Path, run: Run) -> tuple[int, str]:
        SmallCampaign.ran.append(name)
        return run((str(program), name))


@pytest.fixture
def example(sources: Sources, monkeypatch: pytest.MonkeyPatch) -> Sources:
    (sources.folder / PROGRAM_UNIT).write_text(MAIN, encoding="utf-8")
    monkeypatch.setattr(workbench, "Campaign", SmallCampaign)
    return replace(sources, units=(*sources.units, Unit(PROGRAM_UNIT, sources.units[0].flags)), has_campaign=True)


@pytest.mark.verifies("SWR-VER-034")
def test_mutant_is_tried_by_the_campaign_and_then_by_the_tests(example: Sources) -> None:
    report = run_all(example, line=LIMIT_LINE)

    assert find(report, "value < calc_limit", "value <= calc_limit").killer == "campaign/a-1"
    assert find(report, "calc_limit(1)", "calc_limit(0)").killer == "tests/limit_test.cpp"
    report = run_all(example, file=HEADER)
    assert find(report, "10 * scale", "11 * scale").killer == "campaign/a-1"
    assert find(report, "10 * scale", "9 * scale").killer == "compiler, tests/limit_test.cpp"


@pytest.mark.verifies("SWR-VER-034", technique="fault_injection", polarity="violation")
def test_survivor_has_passed_all_cases_and_tests(example: Sources) -> None:
    (example.folder / PROGRAM_UNIT).write_text(MAIN.replace("10", "100"), encoding="utf-8")

    report = run_all(example, line=LIMIT_LINE)

    assert find(report, "value < calc_limit", "value <= calc_limit").verdict == SURVIVED
    assert set(SmallCampaign.ran) == {"a-1", "b-1"}


def make_report(killers: Sequence[str]) -> Report:
    """One mutant of the example per killer; an empty one survives."""
    results = [Result(Mutant("examples/safe_arm/a.cpp", i, i + 1, "", ""), KILLED if killer else SURVIVED, killer) for i, killer in enumerate(killers)]
    return Report(Plan({}, (), {}, (), is_sample=False), tuple(results), ())


@pytest.mark.verifies("SWR-VER-034", technique="boundary_values", polarity="violation")
def test_share_of_the_campaign_is_compared_with_its_limit() -> None:
    rejected, others = [f"{BY_COMPILER}a.cpp"] * 50, ["tests/a_test.cpp"] * 40
    enough = make_report([f"{BY_CAMPAIGN}a-1"] * 60 + others + rejected)

    assert enough.count_campaign(EXAMPLE) == Counts(60, 40)
    assert describe_campaign(enough, EXAMPLE) == ("killed by the campaign: 60.0% (60 of 100 that compile; 60% is the bar); by other tests: 40; by rules"
                                                  " of the compiler: 50")  # fmt: skip
    assert enough.passed
    assert not make_report([f"{BY_CAMPAIGN}a-1"] * 59 + others + rejected).passed
    assert make_report([f"{BY_CAMPAIGN}a-1"] * 98 + ["", ""]).passed
    assert not make_report([f"{BY_CAMPAIGN}a-1"] * 97 + ["", "", ""]).passed


@pytest.mark.verifies("SWR-VER-034", technique="fault_injection", polarity="violation")
def test_case_whose_run_is_not_complete_kills(tmp_path: Path) -> None:
    sut = Campaign(ROOT / EXAMPLE.name / PLAN, tmp_path / "inputs")
    commands: list[Sequence[str]] = []

    def fail(argv: Sequence[str]) -> tuple[int, str]:
        commands.append(argv)
        return 1, "no such motion"

    assert sut.run("power_loss-2", Path("/program"), tmp_path / "run", fail) == (1, "run")
    assert commands[0][:2] == ("/program", "run")
    assert {"none-1", "power_loss-1", "power_loss-3"} < set(sut.names)
    assert sorted(path.name for path in (tmp_path / "inputs").iterdir()) == ["model.yaml", "motion.txt"]


@pytest.mark.verifies("SWR-VER-034", technique="interface")
def test_objects_of_all_copies_are_equal() -> None:
    flags = ("-I/root/arm", '-DARM_FILE="/root/arm/a.yaml"', '-DARM_PROGRAM="/build/arm/arm"', "-DUNUSED=1")

    local = localise(flags, "ARM_FILE ARM_PROGRAM", {"/build/arm/arm": "./program", "/root/arm": "arm"})

    assert local == ("-I/root/arm", '-DARM_FILE="arm/a.yaml"', '-DARM_PROGRAM="./program"')


@pytest.mark.verifies("SWR-VER-033")
def test_example_is_mutated_on_request_only() -> None:
    known = {layer: list_files(ROOT, (layer,)) for layer in ALL_LAYERS}
    own = tuple(known[EXAMPLE])

    assert choose_files((EXAMPLE.name,), known) == own
    assert choose_files(("examples/safe_arm/arm_limits.hpp",), known) == ("examples/safe_arm/arm_limits.hpp",)
    assert set(choose_files((), known)) == set(list_files(ROOT, LAYERS))
    assert len(own) == len(EXAMPLE.files)
    assert {get_layer(file) for file in own} == {EXAMPLE}


@pytest.mark.verifies("SWR-VER-033", technique="error_guessing", polarity="violation")
def test_row_of_the_example_is_refused() -> None:
    with pytest.raises(InputError, match=r"--store: no result of examples/safe_arm is stored; write --results PATH"):
        mutate(Request((EXAMPLE.name,), store=True))


# ---- Results of a stopped run ----------------------------------------------------------------------------------------------


@pytest.mark.verifies("SWR-VER-033")
def test_stopped_run_continues_and_tries_survivors_again(sources: Sources, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = make_plan(sources.root, Selection((SOURCE,), 5, 1), ())
    path = tmp_path / "results.jsonl"
    Journal(path, plan).add(Result(plan.mutants[0], KILLED, "tests/limit_test.cpp"))
    Journal(path, plan).add(Result(plan.mutants[1], SURVIVED))
    tried: list[Mutant] = []

    def try_mutants(_: Sources, mutants: Sequence[Mutant], *rest: object) -> None:
        for mutant in mutants:
            tried.append(mutant)
            rest[3](Result(mutant, SURVIVED))  # type: ignore[operator]

    monkeypatch.setattr(command, "read_sources", lambda *_: sources)
    monkeypatch.setattr(command, "try_mutants", try_mutants)
    (sources.root / "build" / "mutation").mkdir(parents=True)
    report = run_layers(sources.root, plan, 1, lambda *_: None, Journal(path, plan))

    assert tried == list(plan.mutants[1:])
    assert len(report.results) == len(plan.mutants)
    assert len(path.read_text(encoding="utf-8").splitlines()) == 2 + len(tried)


@pytest.mark.verifies("SWR-VER-033", technique="fault_injection", polarity="violation")
def test_result_of_another_state_of_its_file_is_not_used(sources: Sources, tmp_path: Path) -> None:
    plan = make_plan(sources.root, Selection((SOURCE,)), ())
    path = tmp_path / "results.jsonl"
    Journal(path, plan).add(Result(plan.mutants[0], KILLED))
    assert Journal(path, plan).read() == [Result(plan.mutants[0], KILLED)]

    text = (sources.root / SOURCE).read_text(encoding="utf-8")
    (sources.root / SOURCE).write_text(text + "int more() { return 1; }\n", encoding="utf-8")

    assert Journal(path, make_plan(sources.root, Selection((SOURCE,)), ())).read() == []


@pytest.mark.parametrize("text", ["{", "[]", '{"file": "a"}', "\xff"])
@pytest.mark.verifies("SWR-VER-033", technique="error_guessing", polarity="violation")
def test_file_that_has_no_results_is_refused(sources: Sources, tmp_path: Path, text: str) -> None:
    path = tmp_path / "results.jsonl"
    path.write_text(text, encoding="latin-1")

    with pytest.raises(InputError, match=r"mutate: --results: not written by this command"):
        Journal(path, make_plan(sources.root, Selection((SOURCE,)), ())).read()
