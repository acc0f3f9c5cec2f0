# SPDX-License-Identifier: Apache-2.0
# Goal: the result of a mutant is correct, whether it is tried alone or together with others, and its trial terminates.
# Method: the weak layer, changed if a test requires it.
from __future__ import annotations

import os
import time
from dataclasses import replace
from typing import Any

import pytest

from mamori_tools.host.project import ROOT
from mamori_trace.base.errors import WorkError
from verification.mutation import workbench
from verification.mutation.operators import Mutant, make_mutants
from verification.mutation.run import Report, Selection, make_plan, try_mutants
from verification.mutation.sources import Sources, Unit, drop_programs, get_layer, keep_flags, list_files
from verification.mutation.trial import (
    COMPANY,
    EQUIVALENT,
    INVALID,
    KILLED,
    LIKELY,
    SURVIVED,
    Result,
    Suspect,
    judge_together,
    make_companies,
    screen,
)
from verification.mutation.workbench import TIMED_OUT, Baseline, Bench
from verification.tests.support.weak_layer import FILES, FLAGS, HEADER, LIMIT_LINE, SOURCE, TIMEOUT_S, find, run_all, try_alone


def make_suspect(start: int, end: int, file: str = SOURCE) -> Suspect:
    return Suspect(Mutant(file, start, end, "constant", "0"))


@pytest.mark.verifies("SWR-VER-005")
def test_each_mutant_meets_its_fate(weak: Report) -> None:
    assert find(weak, "value < calc_limit", "value <= calc_limit").verdict == SURVIVED
    assert find(weak, "value < calc_limit", "value >= calc_limit").verdict == KILLED
    assert find(weak, "value + nothing", "value - nothing").verdict == EQUIVALENT
    assert find(weak, "case 2 - 0", "case 1 - 0").verdict == INVALID
    total = weak.total
    assert (total.valid, total.same_code > 0, total.invalid > 0) == (total.killed + total.survived, True, True)


@pytest.mark.verifies("SWR-VER-005")
def test_mutant_of_a_header_is_compiled_into_its_tests(sources: Sources) -> None:
    result = find(run_all(sources, file=HEADER), "10 * scale", "10 / scale")

    assert (result.verdict, result.killer) == (KILLED, "compiler, tests/limit_test.cpp")


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_layer_is_tried_on_what_it_stands_on(sources: Sources) -> None:
    """Moves the limit to a lower layer, which is linked but not mutated."""
    base = sources.root / "base" / "src" / "base.cpp"
    base.parent.mkdir(parents=True)
    base.write_text("int calc_base() { return 1; }\n", encoding="utf-8")
    text = FILES[SOURCE].replace("calc_limit(1); }", "calc_limit(calc_base()); }").replace("bool is", "int calc_base();\nbool is")
    (sources.root / SOURCE).write_text(text, encoding="utf-8")
    below = (Unit("base/src/base.cpp", FLAGS),)

    report = run_all(replace(sources, below=below), line=LIMIT_LINE + 1)

    assert find(report, "value < calc_limit", "value >= calc_limit").verdict == KILLED
    assert list(report.layers) == [get_layer(SOURCE)]


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_every_file_is_of_one_layer() -> None:
    files = list_files(ROOT)

    folders = [file.split("/include/")[0].split("/src/")[0] for file in files]
    assert [get_layer(file).name for file in files] == folders
    assert {"kernel/src/base/assert.cpp", "safety/src/reaction/safe_state.cpp", "ports/lcm/src/byte_frame.cpp"} <= set(files)
    assert not any("/tests/" in file for file in files)


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_program_with_options_of_its_own_is_left_out() -> None:
    def compile_into(program: str, file: str) -> dict[str, str]:
        return {"file": f"/{file}", "command": f"c++ -o a/CMakeFiles/{program}.dir/{file}.o -c {file}"}

    kept = [compile_into("mamori_a", "src/one.cpp"), compile_into("a_special_test", "tests/one_test.cpp")]
    special = [compile_into("special_test", "src/one.cpp"), compile_into("special_test", "tests/special_test.cpp")]

    assert drop_programs([*kept, *special], ("special_test",)) == kept


@pytest.mark.verifies("SWR-VER-008", technique="fault_injection", polarity="violation")
def test_mutant_of_a_port_reaches_its_own_processes_only(sources: Sources) -> None:
    """The test would end this process, and leaves a process behind."""
    test = f"""\
#include <signal.h>
#include <unistd.h>
TEST(Port, KillsWhatItCanName) {{
    EXPECT_NE(kill({os.getpid()}, 0), 0);
    if (fork() == 0) {{ sleep(600); }}
}}
"""
    (sources.folder / "tests" / "limit_test.cpp").write_text(test, encoding="utf-8")
    original = Baseline(replace(sources, is_enclosed=True), sources.root / "work", 1)

    assert [Bench(original, "bench").check_original(test) for test in original.tests] == [""]


@pytest.mark.verifies("SWR-VER-005", technique="error_guessing", polarity="violation")
def test_tests_that_fail_by_themselves_kill_nothing(sources: Sources) -> None:
    test = sources.folder / "tests" / "limit_test.cpp"
    test.write_text(FILES["kernel/tests/limit_test.cpp"].replace("keep(5), 5", "keep(5), 6"), encoding="utf-8")

    with pytest.raises(WorkError, match=r"must pass its tests before it is mutated:\n.*limit_test"):
        run_all(sources)


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_test_whose_program_is_the_same_is_not_run(sources: Sources, monkeypatch: pytest.MonkeyPatch) -> None:
    """The second test does not use limit.cpp, so only the first may kill its mutants. Both may kill mutants of the header."""
    other = "tests/other_test.cpp"
    (sources.folder / other).write_text("TEST(Other, Holds) { EXPECT_TRUE(true); }\n", encoding="utf-8")
    units = (*sources.units, Unit(other, sources.units[0].flags))
    original = Baseline(replace(sources, units=units), sources.root / "work", 2)

    assert original.links == {"tests/limit_test.cpp": {"src/limit.cpp"}, other: frozenset()}
    ran: list[str] = []
    bench = Bench(original, "bench")
    run = bench.run_test

    def run_test(test: Unit, *rest: Any) -> tuple[int, str]:
        ran.append(test.path)
        return run(test, *rest)

    monkeypatch.setattr(bench, "run_test", run_test)
    source = (sources.root / SOURCE).read_bytes()
    survivor = next(mutant for mutant in make_mutants(SOURCE, source) if "value <= calc" in mutant.get_change(source)[1])
    assert try_alone(bench, survivor, source).verdict == SURVIVED
    assert ran == ["tests/limit_test.cpp"]


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_likely_killers_come_first(sources: Sources) -> None:
    names = ("tests/another_test.cpp", "tests/limit_life_test.cpp", "tests/limited_test.cpp")
    for name in names:
        (sources.folder / name).write_text("TEST(Other, Holds) { EXPECT_TRUE(true); }\n", encoding="utf-8")
    units = (*sources.units, *(Unit(name, sources.units[0].flags) for name in names))

    original = Baseline(replace(sources, units=units), sources.root / "work", 2)

    assert [test.stem for test in original.order_tests({SOURCE})] == ["limit_test", "limit_life_test", "limited_test", "another_test"]
    original.note_kill(SOURCE, next(test for test in original.tests if test.stem == "another_test"))
    assert original.order_tests({SOURCE})[0].stem == "another_test"
    assert original.order_tests({HEADER})[0].stem == "limit_test"


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_mutants_judged_together_meet_the_fate_that_each_meets_alone(sources: Sources) -> None:
    """Mutants at different locations, none tried before: killed, surviving, rejected and equivalent mutants."""
    text = (sources.root / SOURCE).read_bytes()
    suspects = [Suspect(mutant) for mutant in make_mutants(SOURCE, text)]
    original = Baseline(sources, sources.root / "work", 2, TIMEOUT_S)
    together = Bench(original, "together")
    alone = Bench(original, "alone")

    for company in make_companies(suspects, 1):
        assert len(company) <= COMPANY
        wanted = [try_alone(alone, suspect.mutant, text) for suspect in company]
        assert judge_together(together, company, {SOURCE: text}) == wanted


@pytest.mark.verifies("SWR-VER-005", technique="error_guessing", polarity="violation")
def test_mutants_that_make_up_for_each_other_are_no_kills(sources: Sources) -> None:
    """Both limits moved in opposite directions. The test that checks one number passes for each mutant alone, and fails for both
    together."""
    text = b"#include \"limit.hpp\"\nbool is_allowed(int v) { return v < 5; }\nint keep(int v) { return v; }\n"
    text += b"unsigned count_to(unsigned e) { return e; }\nint add() { return 1 + 1; }\n"
    (sources.root / SOURCE).write_bytes(text)
    test = "int add();\nTEST(Limit, Holds) { EXPECT_LT(add(), 4); }\n"
    (sources.folder / "tests" / "limit_test.cpp").write_text(test, encoding="utf-8")
    more = [mutant for mutant in make_mutants(SOURCE, text) if "return 2 + 1" in mutant.get_change(text)[1]]
    more += [mutant for mutant in make_mutants(SOURCE, text) if "return 1 + 2" in mutant.get_change(text)[1]]
    suspects = [Suspect(mutant) for mutant in more]

    results = judge_together(Bench(Baseline(sources, sources.root / "work", 1), "bench"), suspects, {SOURCE: text})

    assert results == [Result(mutant, SURVIVED) for mutant in more]


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_suspect_has_passed_the_likely_tests_only(sources: Sources) -> None:
    names = [f"tests/limit_{number}_test.cpp" for number in range(LIKELY)]
    for name in names:
        (sources.folder / name).write_text('#include "limit.hpp"\nTEST(Other, Holds) { EXPECT_EQ(keep(5), 5); }\n', encoding="utf-8")
    units = (*sources.units, *(Unit(name, sources.units[0].flags) for name in names))
    original = Baseline(replace(sources, units=units), sources.root / "work", 2)
    text = (sources.root / SOURCE).read_bytes()
    survivor = next(mutant for mutant in make_mutants(SOURCE, text) if "value <= calc" in mutant.get_change(text)[1])

    suspect = screen(Bench(original, "bench"), Suspect(survivor), {SOURCE: text})

    assert isinstance(suspect, Suspect)
    assert (len(suspect.passed), [unit.path for unit in suspect.differing]) == (LIKELY, ["src/limit.cpp"])


@pytest.mark.verifies("SWR-VER-005", technique="boundary_values")
def test_companies_are_small_and_no_two_of_one_change_one_place() -> None:
    neighbours = [make_suspect(start, start + 1) for start in range(2 * COMPANY + 1)]
    assert [len(company) for company in make_companies(neighbours, 1)] == [14, 14, 13]
    assert [len(company) for company in make_companies(neighbours[:2], 4)] == [1, 1]
    assert make_companies([], 2) == []

    nested = [make_suspect(0, 9), make_suspect(3, 4), make_suspect(9, 10), make_suspect(3, 4, HEADER)]
    assert make_companies(nested, 1) == [[nested[0], nested[2]], [nested[1], nested[3]]]


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_sources_are_left_as_they_were(sources: Sources) -> None:
    run_all(sources, line=LIMIT_LINE)

    assert {name: (sources.root / name).read_text(encoding="utf-8") for name in FILES} == FILES


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_only_flags_that_decide_the_meaning_are_kept() -> None:
    command = ["/usr/bin/c++", "-DA=1", "-I/i", "-isystem", "/s", "-O2", "-g", "-Wall", "-Werror", "-std=c++17", "-fno-rtti",
               "-MD", "-MF", "a.d", "-o", "a.o", "-c", "/a.cpp"]  # fmt: skip

    assert keep_flags(command) == ("-DA=1", "-I/i", "-isystem", "/s", "-std=c++17", "-fno-rtti")


@pytest.mark.verifies("SWR-VER-008", technique="fault_injection", polarity="violation")
def test_mutant_that_never_ends_is_killed_in_time(sources: Sources) -> None:
    original = Baseline(sources, sources.root / "work", 1, test_timeout_s=TIMEOUT_S)
    source = (sources.root / SOURCE).read_bytes()
    endless = next(mutant for mutant in make_mutants(SOURCE, source) if mutant.get_change(source)[1] == "while (i != end) { ; }")

    result = try_alone(Bench(original, "bench"), endless, source)

    assert (result.verdict, result.killer) == (KILLED, f"tests/limit_test.cpp {TIMED_OUT}")


@pytest.mark.verifies("SWR-VER-008", technique="fault_injection", polarity="violation")
def test_stopped_run_begins_no_other_test(sources: Sources, monkeypatch: pytest.MonkeyPatch) -> None:
    """The first result stops the run, like Ctrl-C, while both benches work."""
    calls: list[float] = []
    run = workbench._run

    def note(*rest: Any) -> tuple[int, str]:
        calls.append(time.monotonic())
        return run(*rest)

    monkeypatch.setattr(workbench, "_run", note)
    plan = make_plan(sources.root, Selection((SOURCE,)), ())
    stopped: list[float] = []

    def stop(_: Result) -> None:
        stopped.append(time.monotonic())
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        try_mutants(sources, plan.mutants, plan.sources, sources.root / "work", 2, stop, TIMEOUT_S)

    assert len(stopped) == 1
    assert sum(call > stopped[0] for call in calls) <= 2


@pytest.mark.verifies("SWR-VER-008")
def test_tests_of_a_sound_kernel_are_given_their_time(sources: Sources) -> None:
    original = Baseline(sources, sources.root / "work", 1)

    assert [Bench(original, "bench").check_original(test) for test in original.tests] == [""]
