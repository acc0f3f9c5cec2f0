# SPDX-License-Identifier: Apache-2.0
# Goal: the tests of kernel, safety and ports find most small faults, and the calculated score is correct.
# Method: the stored result and a sample of each shipped layer; the weak layer.
from __future__ import annotations

import os
import re
from functools import partial
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT, Project
from mamori_trace.base.errors import InputError, WorkError
from verification.mutation import baseline
from verification.mutation.command import Keeper, OutOfTimeError, Progress, choose_files, describe, read_standing, run_layers
from verification.mutation.equivalent import Row, read_list
from verification.mutation.renamed import read_renamed
from verification.mutation.run import Plan, Report, Selection, make_plan, make_table, write_json
from verification.mutation.score import LISTED, Counts, calc_interval, is_met
from verification.mutation.sources import LAYERS, Layer, Sources, list_files
from verification.mutation.trial import KILLED, SURVIVED, Result
from verification.tests.support.weak_layer import FILES, HEADER, LIMIT_LINE, SOURCE, find, run_all

SAMPLES = {"kernel": 60, "safety": 40, "ports/conformance": 30, "ports/lcm": 30, "ports/posix_rt": 30, "ports/virtual_time": 30}
SEED = 1


def strengthen(sources: Sources) -> None:
    """Adds the missing check of the limit to the test."""
    test = sources.folder / "tests" / "limit_test.cpp"
    test.write_text(test.read_text(encoding="utf-8").replace("is_allowed(100)", "is_allowed(10)"), encoding="utf-8")


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
    with pytest.raises(InputError, match=r"'kernel/src/event_lock.cpp' is no source or header of kernel, safety, ports or.*kernel/src/record/event_log.cpp"):
        choose_files(("kernel/src/event_lock.cpp",), {LAYERS[0]: ("kernel/src/record/event_log.cpp", "kernel/src/base/assert.cpp")})


@pytest.mark.verifies("SWR-VER-004", technique="error_guessing", polarity="violation")
def test_file_that_is_like_none_of_the_kernels_is_refused_in_one_short_line() -> None:
    with pytest.raises(InputError) as refusal:
        choose_files(("nothing.cpp",), {LAYERS[0]: [f"kernel/include/mamori/kernel/unit_{i}.hpp" for i in range(200)]})
    assert str(refusal.value) == ("mutate: 'nothing.cpp' is no source or header of kernel, safety, ports or examples/safe_arm; "
                                  "./mamori mutate --list shows them with their mutants")  # fmt: skip


@pytest.mark.verifies("SWR-VER-004", technique="boundary_values")
def test_run_stops_at_its_time_limit_unless_it_is_complete(weak: Report) -> None:
    result = weak.results[0]
    Progress(weak.plan, 1)(result, 1, 2)
    late = Progress(weak.plan, 0)
    late(result, 2, 2)
    with pytest.raises(OutOfTimeError):
        late(result, 1, 2)


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


# No `verifies`: the test is `long`, so the CI gate would lack its result. The stored rows are the results for SWR-VER-006.
@pytest.mark.long
@pytest.mark.parametrize("layer", LAYERS, ids=lambda layer: layer.name)
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
    """Compares a store of one row (100 mutants of kernel/a.cpp, whose content was b"a") with the sources and numbers of mutants in
    `now`."""
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


CODE = b"#include <a/b.hpp>\n#define A 1\nint f(int a) { return a < 1; }\nauto t = \"a  b\"; auto c = ' ';\n"


@pytest.mark.parametrize(
    "same", [CODE.replace(b"{ ", b"{\n  // why\n  "), b"// Licence\n/// @file\n" + CODE, CODE.replace(b"a < 1", b"a /* x */  <  1"),
             CODE.replace(b"a/b", b"c/b")],
    ids=["line broken", "comment before", "comment within", "header moved"],
)  # fmt: skip
@pytest.mark.verifies("SWR-VER-009", technique="equivalence_classes")
def test_row_outlives_a_change_of_comments_spaces_and_includes(same: bytes) -> None:
    assert baseline.fingerprint(same) == baseline.fingerprint(CODE)


@pytest.mark.parametrize(
    ("old", "new"), [(b"a < 1", b"a < 2"), (b"a < 1", b"a <= 1"), (b"a  b", b"a b"), (b"' '", b"'  '"), (b"A 1", b"A 2"), (b"int f", b"intf")],
    ids=["number", "operator", "text", "character", "macro", "word"],
)  # fmt: skip
@pytest.mark.verifies("SWR-VER-009", technique="equivalence_classes", polarity="violation")
def test_row_falls_with_any_change_of_the_code(old: bytes, new: bytes) -> None:
    assert old in CODE
    assert baseline.fingerprint(CODE.replace(old, new)) != baseline.fingerprint(CODE)


@pytest.mark.verifies("SWR-VER-030")
def test_row_stays_valid_when_an_identifier_is_renamed() -> None:
    renamed = CODE.replace(b"f(int a)", b"f(int speed)").replace(b"a < 1", b"speed < 1")

    assert baseline.fingerprint(renamed, {b"speed": b"a"}) == baseline.fingerprint(CODE, {})


@pytest.mark.parametrize(
    ("source", "former"),
    [(CODE.replace(b"int a", b"int b"), {b"b": b"a"}), (CODE.replace(b"a < 1", b"c < 2"), {b"c": b"a"}), (CODE.replace(b"int f", b"int g"), {b"h": b"f"}),
     (CODE.replace(b"a  b", b"text"), {b"text": b"a  b"})],
    ids=["former name still present", "number changed as well", "name not in the list", "text"],
)  # fmt: skip
@pytest.mark.verifies("SWR-VER-030", technique="equivalence_classes", polarity="violation")
def test_row_is_invalid_after_any_other_change(source: bytes, former: dict[bytes, bytes]) -> None:
    assert source != CODE
    assert baseline.fingerprint(source, former) != baseline.fingerprint(CODE, {})


@pytest.mark.parametrize(
    ("text", "message"),
    [("a = 1\n", "'a': a row is new_name"), ('a = "b c"\n', "'a': a row is new_name"), ('"a b" = "c"\n', "'a b': a row is new_name"),
     ('a = "c"\nb = "c"\n', "'b': 'c' occurs in two rows"), ('a = "b"\nb = "c"\n', "'a': 'b' occurs in two rows"), ("a =\n", "invalid TOML")],
)  # fmt: skip
@pytest.mark.verifies("SWR-VER-030", technique="error_guessing", polarity="violation")
def test_list_of_renamed_identifiers_rejects_an_unusable_row(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "renamed.toml"
    path.write_text(text, encoding="utf-8")

    with pytest.raises(WorkError, match=re.escape(message)):
        read_renamed(path)


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

    with pytest.raises(WorkError, match="is no stored result"):
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

    with pytest.raises(WorkError, match=message):
        read_list(path)
