# SPDX-License-Identifier: Apache-2.0
"""A small layer with one mutant of each outcome: its test never checks the limit itself."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

from verification.mutation.equivalent import Row
from verification.mutation.operators import Mutant
from verification.mutation.run import Report, Selection, Tally, make_plan, try_mutants
from verification.mutation.sources import Sources, Unit
from verification.mutation.trial import Result, Suspect, judge_together, screen
from verification.mutation.workbench import Bench

# For a test of a few milliseconds. A mutant runs the loop in the wrong direction; its 64-bit counter never reaches the end in time.
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
    """A project with one header, one source and a test that never checks the limit itself."""
    for name, text in FILES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")
    flags = (*FLAGS, f"-I{root / 'kernel' / 'include'}")
    units = tuple(Unit(path, flags) for path in ("src/limit.cpp", "tests/limit_test.cpp"))
    return Sources(root, units, prefix_headers=("<gtest/gtest.h>",))


def run_all(sources: Sources, *rows: Row, file: str = SOURCE, line: int | None = None) -> Report:
    """@param line try only the mutants of this line."""
    plan = make_plan(sources.root, Selection((file,)), rows)
    if line is not None:
        plan = replace(plan, mutants=tuple(each for each in plan.mutants if each.get_line(plan.sources[file]) == line))
    tally = Tally(plan, lambda *_: None)
    folder = Path(tempfile.mkdtemp(dir=sources.root))
    try_mutants(sources, plan.mutants, plan.sources, folder, 2, tally.note, TIMEOUT_S)
    return tally.make_report()


def try_alone(bench: Bench, mutant: Mutant, source: bytes) -> Result:
    sources = {mutant.file: source}
    tried = screen(bench, Suspect(mutant), sources)
    result = tried if isinstance(tried, Result) else judge_together(bench, (tried,), sources)[0]
    assert isinstance(result, Result)
    return result


def find(report: Report, before: str, after: str) -> Result:
    """The result of the mutant whose changed line contains `after` instead of `before`."""
    for result in report.results:
        change = result.mutant.get_change(report.plan.sources[result.mutant.file])
        if change[0].replace(before, after, 1) == change[1]:
            return result
    raise AssertionError(f"no mutant turns {before} into {after}")
