# SPDX-License-Identifier: Apache-2.0
# Goal: the tests of kernel and safety find most small faults, and what this tool says about that is true.
# Method: the stored result and a sample of each shipped layer; a small project with one mutant of each fate.
from __future__ import annotations

import os
import tempfile
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from mamori.verification.command.errors import UsageError
from mamori.verification.command.project import ROOT, Project
from mamori.verification.mutation import baseline, workbench
from mamori.verification.mutation.command import Keeper, choose_files, describe, read_standing, run_layers
from mamori.verification.mutation.equivalent import Row, read_list
from mamori.verification.mutation.operators import Mutant, make_mutants
from mamori.verification.mutation.run import Plan, Report, Selection, Tally, make_plan, make_table, try_mutants, write_json
from mamori.verification.mutation.score import LISTED, Counts, calc_interval, is_met
from mamori.verification.mutation.sources import LAYERS, Layer, MutationError, Sources, Unit, get_layer, keep_flags, list_files
from mamori.verification.mutation.trial import (
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
from mamori.verification.mutation.workbench import TIMED_OUT, Baseline, Bench

SAMPLES = {"kernel": 60, "safety": 40}
SEED = 1
# Of a test that needs a few milliseconds. The loop that a mutant lets run the wrong way counts in 64 bits, so it never ends in time.
TIMEOUT_S = 2.0

HEADER = "kernel/include/limit.hpp"
SOURCE = "kernel/src/limit.cpp"
FILES = {
    HEADER: """\
constexpr int calc_limit(int scale) { return 10 * scale; }
bool is_allowed(int value);
int keep(int value);
unsigned long long count_to(unsigned long long end);
""",
    SOURCE: """\
#include "limit.hpp"
bool is_allowed(int value) { return value < calc_limit(1); }
int keep(int value) { const int nothing = 0 * value; return value + nothing; }
unsigned long long count_to(unsigned long long end) {
    unsigned long long i = 0U;
    while (i != end) { ++i; }
    return i;
}
enum Code { kFirst = 1 };
int pick(Code code) { switch (code) { case kFirst: return 1; case 2 - 0: return 2; } return 3; }
""",
    "kernel/tests/limit_test.cpp": """\
#include "limit.hpp"
static_assert(calc_limit(2) == 20);
TEST(Limit, Holds) {
    EXPECT_TRUE(is_allowed(0));
    EXPECT_FALSE(is_allowed(100));
    EXPECT_EQ(count_to(3U), 3U);
}
TEST(Keep, Keeps) { EXPECT_EQ(keep(5), 5); }
""",
}
FLAGS = ("-std=c++17", "-fno-exceptions")
LIMIT_LINE = 2


def make_sources(root: Path) -> Sources:
    """A project with one header, one source and a test that never looks at the limit itself."""
    for name, text in FILES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")
    flags = (*FLAGS, f"-I{root / 'kernel' / 'include'}")
    units = tuple(Unit(path, flags) for path in ("src/limit.cpp", "tests/limit_test.cpp"))
    return Sources(root, units, prefix_header="gtest/gtest.h")


@pytest.fixture
def sources(tmp_path: Path) -> Sources:
    return make_sources(tmp_path)


@pytest.fixture(scope="module")
def weak(tmp_path_factory: pytest.TempPathFactory) -> Report:
    """The whole run of that project."""
    return run_all(make_sources(tmp_path_factory.mktemp("weak")))


def strengthen(sources: Sources) -> None:
    """Gives the test the limit that it leaves out."""
    test = sources.folder / "tests" / "limit_test.cpp"
    test.write_text(test.read_text(encoding="utf-8").replace("is_allowed(100)", "is_allowed(10)"), encoding="utf-8")


def run_all(sources: Sources, *rows: Row, file: str = SOURCE, line: int | None = None) -> Report:
    """@param line try the mutants of this line only."""
    plan = make_plan(sources.root, Selection((file,)), rows)
    if line is not None:
        plan = replace(plan, mutants=tuple(each for each in plan.mutants if each.get_line(plan.sources[file]) == line))
    tally = Tally(plan, lambda *_: None)
    folder = Path(tempfile.mkdtemp(dir=sources.root))
    try_mutants(sources, plan.mutants, plan.sources, folder, 2, tally.note, TIMEOUT_S)
    return tally.make_report()


def try_alone(bench: Bench, mutant: Mutant, source: bytes) -> Result:
    sources = {mutant.file: source}
    tried = screen(bench, mutant, sources)
    return tried if isinstance(tried, Result) else judge_together(bench, (tried,), sources)[0]


def find(report: Report, before: str, after: str) -> Result:
    """The result of the mutant whose changed line holds `after` in place of `before`."""
    for result in report.results:
        change = result.mutant.get_change(report.plan.sources[result.mutant.file])
        if change[0].replace(before, after, 1) == change[1]:
            return result
    raise AssertionError(f"no mutant turns {before} into {after}")


# ---- Choice of mutants -----------------------------------------------------------------------------------------------


@pytest.mark.verifies("SWR-VER-004")
def test_one_seed_gives_one_sample_and_another_seed_another(sources: Sources) -> None:
    def choose(seed: int, size: int | None = 8) -> Plan:
        return make_plan(sources.root, Selection((SOURCE, HEADER), size, seed), ())

    everything = choose(1, None)
    assert choose(1).mutants == choose(1).mutants
    assert choose(1).mutants != choose(2).mutants
    assert set(choose(1).mutants) < set(everything.mutants)
    assert (len(choose(1).mutants), choose(1).is_sample) == (8, True)
    assert (choose(1, 1000).mutants, choose(1, 1000).is_sample) == (everything.mutants, False)


@pytest.mark.verifies("SWR-VER-004", technique="error_guessing", polarity="violation")
def test_file_that_is_none_of_the_kernels_is_refused_with_the_nearest() -> None:
    with pytest.raises(UsageError, match=r"'kernel/src/event_lock.cpp' is no source or header of kernel or safety.*kernel/src/event_log.cpp"):
        choose_files(("kernel/src/event_lock.cpp",), ("kernel/src/event_log.cpp", "kernel/src/assert.cpp"))


@pytest.mark.verifies("SWR-VER-004", technique="error_guessing", polarity="violation")
def test_file_that_is_like_none_of_the_kernels_is_refused_in_one_short_line() -> None:
    with pytest.raises(UsageError) as refusal:
        choose_files(("nothing.cpp",), tuple(f"kernel/include/mamori/kernel/unit_{i}.hpp" for i in range(200)))
    assert str(refusal.value) == ("mutate: 'nothing.cpp' is no source or header of kernel or safety; "
                                  "./mamori mutate --list shows them with their mutants")  # fmt: skip


# ---- What becomes of a mutant ------------------------------------------------------------------------------------------


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
    """The limit moves to a layer below, which is linked and not mutated."""
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

    assert [get_layer(file).name for file in files] == [file.partition("/")[0] for file in files]
    assert {"kernel/src/assert.cpp", "safety/src/safe_state.cpp"} <= set(files)
    assert not any("/tests/" in file for file in files)


@pytest.mark.verifies("SWR-VER-005", technique="error_guessing", polarity="violation")
def test_tests_that_fail_by_themselves_kill_nothing(sources: Sources) -> None:
    test = sources.folder / "tests" / "limit_test.cpp"
    test.write_text(FILES["kernel/tests/limit_test.cpp"].replace("keep(5), 5", "keep(5), 6"), encoding="utf-8")

    with pytest.raises(MutationError, match=r"must pass its tests before it is mutated:\n.*limit_test"):
        run_all(sources)


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_test_whose_program_is_the_same_is_not_run(sources: Sources) -> None:
    """The second test takes nothing of limit.cpp, so only the first may kill its mutants; those of the header reach both."""
    other = "tests/other_test.cpp"
    (sources.folder / other).write_text("TEST(Other, Holds) { EXPECT_TRUE(true); }\n", encoding="utf-8")
    units = (*sources.units, Unit(other, sources.units[0].flags))
    original = Baseline(replace(sources, units=units), sources.root / "work", 2)

    assert original.links == {"tests/limit_test.cpp": {"src/limit.cpp"}, other: frozenset()}
    ran: list[str] = []
    bench = Bench(original, "bench")
    run = bench.run_test
    bench.run_test = lambda test, *rest: (ran.append(test.path), run(test, *rest))[1]  # type: ignore[method-assign]
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


def make_suspect(start: int, end: int, file: str = SOURCE) -> Suspect:
    return Suspect(Mutant(file, start, end, "constant", "0"), frozenset(), ())


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_mutants_judged_together_meet_the_fate_that_each_meets_alone(sources: Sources) -> None:
    """All mutants that do not change one place, none of them screened: found ones, survivors, refused ones and equals."""
    text = (sources.root / SOURCE).read_bytes()
    suspects = [Suspect(mutant, frozenset(), ()) for mutant in make_mutants(SOURCE, text)]
    original = Baseline(sources, sources.root / "work", 2, TIMEOUT_S)
    together = Bench(original, "together")
    alone = Bench(original, "alone")

    for company in make_companies(suspects, 1):
        assert len(company) <= COMPANY
        wanted = [try_alone(alone, suspect.mutant, text) for suspect in company]
        assert judge_together(together, company, {SOURCE: text}) == wanted


@pytest.mark.verifies("SWR-VER-005", technique="error_guessing", polarity="violation")
def test_mutants_that_make_up_for_each_other_are_no_kills(sources: Sources) -> None:
    """Both limits moved apart: the test that knows one number only passes each alone, and fails for the two together."""
    text = b"#include \"limit.hpp\"\nbool is_allowed(int v) { return v < 5; }\nint keep(int v) { return v; }\n"
    text += b"unsigned count_to(unsigned e) { return e; }\nint add() { return 1 + 1; }\n"
    (sources.root / SOURCE).write_bytes(text)
    test = "int add();\nTEST(Limit, Holds) { EXPECT_LT(add(), 4); }\n"
    (sources.folder / "tests" / "limit_test.cpp").write_text(test, encoding="utf-8")
    more = [mutant for mutant in make_mutants(SOURCE, text) if "return 2 + 1" in mutant.get_change(text)[1]]
    more += [mutant for mutant in make_mutants(SOURCE, text) if "return 1 + 2" in mutant.get_change(text)[1]]
    suspects = [Suspect(mutant, frozenset(), ()) for mutant in more]

    results = judge_together(Bench(Baseline(sources, sources.root / "work", 1), "bench"), suspects, {SOURCE: text})

    assert [result.verdict for result in results] == [SURVIVED, SURVIVED]


@pytest.mark.verifies("SWR-VER-005", technique="interface")
def test_suspect_has_passed_the_likely_tests_only(sources: Sources) -> None:
    names = [f"tests/limit_{number}_test.cpp" for number in range(LIKELY)]
    for name in names:
        (sources.folder / name).write_text('#include "limit.hpp"\nTEST(Other, Holds) { EXPECT_EQ(keep(5), 5); }\n', encoding="utf-8")
    units = (*sources.units, *(Unit(name, sources.units[0].flags) for name in names))
    original = Baseline(replace(sources, units=units), sources.root / "work", 2)
    text = (sources.root / SOURCE).read_bytes()
    survivor = next(mutant for mutant in make_mutants(SOURCE, text) if "value <= calc" in mutant.get_change(text)[1])

    suspect = screen(Bench(original, "bench"), survivor, {SOURCE: text})

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
    """Stopped by the first result, as by Ctrl-C; both benches are at work then."""
    calls: list[float] = []
    monkeypatch.setattr(workbench, "_run", lambda *rest, run=workbench._run: (calls.append(time.monotonic()), run(*rest))[1])
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


# ---- Score -------------------------------------------------------------------------------------------------------------


@pytest.mark.verifies("SWR-VER-006", technique="fault_injection", polarity="violation")
def test_survivor_is_shown_with_its_change_and_fails_a_score_below_the_bar(weak: Report) -> None:
    assert not weak.passed
    lines = describe(weak)
    limit = "bool is_allowed(int value) { return value < calc_limit(1); }"
    assert f"{SOURCE}:2: survived: {limit}  ->  {limit.replace('<', '<=')}" in lines
    survivor = find(weak, "value < calc_limit", "value <= calc_limit").mutant
    diff = survivor.make_diff(weak.plan.sources[SOURCE])
    assert f"\n-{limit}\n+{limit.replace('<', '<=')}\n" in diff


@pytest.mark.verifies("SWR-VER-006")
def test_stronger_test_raises_the_score(sources: Sources) -> None:
    weak = run_all(sources, line=LIMIT_LINE).total
    strengthen(sources)
    strong = run_all(sources, line=LIMIT_LINE).total

    assert weak.score < strong.score == 1.0
    assert strong.valid == weak.valid


@pytest.mark.parametrize(
    ("killed", "survived", "bar", "is_sample", "wanted"),
    [(90, 10, 0.9, False, True), (899, 101, 0.9, False, False), (0, 0, 0.9, False, True), (60, 0, 0.9, True, True),
     (50, 10, 0.9, True, True), (49, 11, 0.9, True, False), (95, 5, 0.95, False, True), (949, 51, 0.95, False, False),
     (36, 4, 0.95, True, True), (35, 5, 0.95, True, False)],
)  # fmt: skip
@pytest.mark.verifies("SWR-VER-006", technique="boundary_values", polarity="violation")
def test_bar_is_held_on_both_sides(killed: int, survived: int, bar: float, is_sample: bool, wanted: bool) -> None:
    assert is_met(Counts(killed, survived), bar, is_sample) == wanted


@pytest.mark.verifies("SWR-VER-006")
def test_stored_result_meets_the_bar_of_each_layer() -> None:
    assert read_standing(ROOT).findings == []


@pytest.mark.parametrize("layer", LAYERS, ids=lambda layer: layer.name)
@pytest.mark.verifies("SWR-VER-006")
def test_sample_does_not_contradict_the_bar(layer: Layer) -> None:
    project = Project(ROOT)
    selection = Selection(tuple(list_files(ROOT, (layer,))), SAMPLES[layer.name], SEED)
    plan = make_plan(ROOT, selection, read_list())
    report = run_layers(ROOT, plan, os.cpu_count() or 1, lambda *_: None)
    standing = read_standing(ROOT)
    folder = project.evidence / "mutation" / layer.name
    write_json(folder / "mutation.json", report, selection, standing)
    told = [make_table(report.files), *standing.describe(), *describe(report)]
    (folder / "mutation.txt").write_text("\n".join(told) + "\n", encoding="utf-8")

    assert report.passed, "\n".join(told)


def judge(now: dict[str, tuple[bytes, int]], *, killed: int = 89) -> baseline.Standing:
    """A store with one row, of 100 mutants of kernel/a.cpp when it was b"a", beside the sources and numbers of mutants of `now`."""
    entry = baseline.Entry(baseline.fingerprint(b"a"), "0123", "2026-11-22", Counts(killed, 100 - killed))
    mutated = {file: baseline.Mutated(baseline.fingerprint(source), mutants) for file, (source, mutants) in now.items()}
    return baseline.judge_store({"kernel/a.cpp": entry}, mutated)


@pytest.mark.verifies("SWR-VER-006", technique="fault_injection", polarity="violation")
def test_stored_result_below_the_bar_or_of_a_file_that_is_gone_fails() -> None:
    below = ["the stored mutation score of kernel is 89.0% (89 of 100); 90% is the bar"]
    assert judge({"kernel/a.cpp": (b"a", 100)}).findings == below
    assert judge({"kernel/a.cpp": (b"a", 100)}, killed=90).findings == []
    assert "kernel/a.cpp is stored but gives no mutants" in judge({}).findings[0]


@pytest.mark.parametrize("now", [(b"b", 100), (b"a", 101)], ids=["file changed", "operators changed"])
@pytest.mark.verifies("SWR-VER-009", technique="equivalence_classes", polarity="violation")
def test_row_of_another_state_of_its_file_counts_for_nothing(now: tuple[bytes, int]) -> None:
    standing = judge({"kernel/a.cpp": now})

    assert (standing.layers, standing.findings) == ({}, [])
    told = standing.describe()
    assert f"kernel, not measured as a whole: 1 files, {now[1]} mutants" in told
    assert told[-1] == f"not measured: kernel/a.cpp ({now[1]} mutants)"
    assert standing.to_json()["not_measured"] == {"files": {"kernel/a.cpp": now[1]}, "mutants": now[1]}


CODE = b"#define A 1\nint f(int a) { return a < 1; }\nauto t = \"a  b\"; auto c = ' ';\n"


@pytest.mark.parametrize(
    "same", [CODE.replace(b"{ ", b"{\n  // why\n  "), b"// Licence\n/// @file\n" + CODE, CODE.replace(b"a < 1", b"a /* x */  <  1")],
    ids=["line broken", "comment before", "comment within"],
)  # fmt: skip
@pytest.mark.verifies("SWR-VER-009", technique="equivalence_classes")
def test_row_outlives_a_change_of_comments_and_spaces(same: bytes) -> None:
    assert baseline.fingerprint(same) == baseline.fingerprint(CODE)


@pytest.mark.parametrize(
    ("old", "new"), [(b"a < 1", b"a < 2"), (b"a < 1", b"a <= 1"), (b"a  b", b"a b"), (b"' '", b"'  '"), (b"A 1", b"A 2"), (b"int f", b"intf")],
    ids=["number", "operator", "text", "character", "macro", "word"],
)  # fmt: skip
@pytest.mark.verifies("SWR-VER-009", technique="equivalence_classes", polarity="violation")
def test_row_falls_with_any_change_of_the_code(old: bytes, new: bytes) -> None:
    assert old in CODE
    assert baseline.fingerprint(CODE.replace(old, new)) != baseline.fingerprint(CODE)


@pytest.mark.verifies("SWR-VER-009", technique="interface")
def test_file_without_a_row_is_named_beside_the_measured_ones() -> None:
    standing = judge({"kernel/a.cpp": (b"a", 100), "safety/b.cpp": (b"b", 7)}, killed=95)

    assert standing.describe() == ["kernel, stored whole runs: 95.0% (95 of 100 killed; 1 files, 100 mutants)",
                                   "kernel, not measured as a whole: 0 files, 0 mutants",
                                   "safety, stored whole runs: - (0 of 0 killed; 0 files, 0 mutants)",
                                   "safety, not measured as a whole: 1 files, 7 mutants",
                                   "not measured: safety/b.cpp (7 mutants)"]  # fmt: skip
    assert standing.findings == []


@pytest.mark.verifies("SWR-VER-009", technique="interface")
def test_row_of_each_file_is_stored_when_its_last_mutant_was_tried(
    sources: Sources, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(baseline, "read_store", partial(baseline.read_store, tmp_path / "stored.toml"))
    write = baseline.write_store
    monkeypatch.setattr(baseline, "write_store", lambda entries: write(entries, tmp_path / "stored.toml"))
    plan = make_plan(sources.root, Selection((HEADER, SOURCE)), ())
    keep = Keeper(sources.root, plan, lambda *_: None)
    first = [mutant for mutant in plan.mutants if mutant.file == HEADER]

    for mutant in first[:-1]:
        keep(Result(mutant, KILLED), 1, len(plan.mutants))
    assert baseline.read_store() == {}
    keep(Result(first[-1], SURVIVED), len(first), len(plan.mutants))

    assert {file: entry.counts for file, entry in baseline.read_store().items()} == {HEADER: Counts(len(first) - 1, 1)}


@pytest.mark.parametrize(("killed", "valid", "low", "high"), [(54, 60, 0.7985, 0.9534), (60, 60, 0.9398, 1.0), (0, 0, 0.0, 1.0)])
@pytest.mark.verifies("SWR-VER-006", technique="equivalence_classes")
def test_sample_is_shown_with_its_interval(killed: int, valid: int, low: float, high: float) -> None:
    assert calc_interval(killed, valid) == pytest.approx((low, high), abs=1e-4)


@pytest.mark.verifies("SWR-VER-006", technique="error_guessing", polarity="violation")
def test_stored_result_that_is_none_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "baseline.toml"
    path.write_text('["a.cpp"]\ncounts = {killed = 1}\n', encoding="utf-8")

    with pytest.raises(MutationError, match="is no stored result"):
        baseline.read_store(path)


# ---- Equivalent mutants ------------------------------------------------------------------------------------------------

LIMIT_ROW = Row(SOURCE, "bool is_allowed(int value) { return value < calc_limit(1); }",
                "bool is_allowed(int value) { return value <= calc_limit(1); }", "Only a sample of the limit.")  # fmt: skip


@pytest.mark.verifies("SWR-VER-007")
def test_listed_mutant_does_not_count(sources: Sources) -> None:
    report = run_all(sources, LIMIT_ROW, line=LIMIT_LINE)

    assert find(report, "value < calc_limit", "value <= calc_limit").verdict == LISTED
    assert report.total.listed == 1
    assert report.wrong_rows == ()


@pytest.mark.verifies("SWR-VER-007", technique="fault_injection", polarity="violation")
def test_listed_mutant_that_a_test_kills_fails(sources: Sources) -> None:
    strengthen(sources)

    report = run_all(sources, LIMIT_ROW, line=LIMIT_LINE)

    assert not report.passed
    assert any("tests/limit_test.cpp kills this mutant, so it is not equivalent" in line for line in describe(report))


@pytest.mark.verifies("SWR-VER-007", technique="interface")
def test_row_outlives_another_comment_and_other_spacing(sources: Sources) -> None:
    text = FILES[SOURCE].replace("value < calc_limit(1); }", "value  <  calc_limit(1); }  ///< below the limit")
    (sources.root / SOURCE).write_text(text, encoding="utf-8")

    plan = make_plan(sources.root, Selection((SOURCE,)), [LIMIT_ROW])

    assert (list(plan.listed.values()), plan.unused) == ([LIMIT_ROW], ())


@pytest.mark.verifies("SWR-VER-007", technique="fault_injection", polarity="violation")
def test_row_that_names_no_mutant_fails(sources: Sources) -> None:
    row = Row(SOURCE, "return old < new;", "return old <= new;", "It was so.")
    plan = make_plan(sources.root, Selection((SOURCE,)), [row])

    report = Report(plan, (), ())

    assert not report.passed
    assert describe(report)[0] == f"equivalent.toml: row names no mutant any more, remove it: {row}"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[[mutant]]\nfile = "a"\nbefore = "b"\nafter = "c"\n', "row 1 needs after, before, file, reason"),
        ('[[mutant]]\nfile = "a"\nbefore = "b"\nafter = "c"\nreason = ""\n', "gives no reason"),
        ('[[mutant]]\nfile = "a"\nbefore = "b"\nafter = "c"\nreason = "r"\n' * 2, "is there twice"),
        ("[[mutant]\n", "equivalent.toml"),
    ],
)
@pytest.mark.verifies("SWR-VER-007", technique="equivalence_classes", polarity="violation")
def test_list_that_is_not_whole_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "equivalent.toml"
    path.write_text(text, encoding="utf-8")

    with pytest.raises(MutationError, match=message):
        read_list(path)
