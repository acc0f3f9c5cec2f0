# SPDX-License-Identifier: Apache-2.0
# Goal: each operator makes exactly the changes that the design document lists.
# Method: short texts, each with the list of all its mutants.
from __future__ import annotations

import pytest

from verification.mutation.operators import make_mutants

CHANGES = {
    "bool f(int a) { return a < b; }": ["a <= b", "a >= b"],
    "bool f(int a) { return a == b; }": ["a != b"],
    "void f() { if (a && b()) { g(); } }": ["if (a || b())", "if (!(a) && b())", "if (a && !(b()))", "{ ; }"],
    "void f() { while (a) {} }": ["while (!(a))"],
    "int f() { return a + 2; }": ["a - 2", "a + 3", "a + 1", "(a + 2) + 1"],
    "int g{0};": ["g{1}"],
    "double f() { return 1.5; }": ["(1.5 + 1.0)"],
    "void f() { ++a; }": ["--a", "{ ; }"],
    "void f() { a += b; }": ["a -= b", "{ ; }"],
    "bool f() { return !a; }": ["return a;"],
    "bool f() { return true; }": ["return false;"],
    "bool f() { return g(); }": ["return !(g());"],
    "Status f() { return Status::kOk; }": ["return Status::kError;"],
    "Status f() { return g(); }": ["return Status::kOk;"],
    "void f() { for (;;) { break; } }": ["{ ; }"],
    'const char* f() { return "name"; }': ['return "";'],
    "void f() { MAMORI_REQUIRE(7, a < b); }": ["(7, a <= b)", "(7, a >= b)", "{ ; }"],
}


# Changes of an example that no other layer has.
WIRING = {
    "double a{1.5};": ["{(2.0 * 1.5)}", "{(0.5 * 1.5)}", "{(-1.5)}"],
    "double a{0.0};": [],
    "auto a = 90_ms;": ["180_ms", "45_ms"],
    "auto a = 1U;": [],  # `constant` makes 0 and 2
    "V a{1, 2, 3};": ["{2, 1, 3}", "{1, 3, 2}", "{2, 3}", "{1, 3}", "{1, 2}", "{1, 4, 3}", "{1, 2, 1}", "{1, 2, 6}"],
    "void f() { set(a.x, a.y); }": ["(a.y, a.x)", "(a.y, a.y)", "(a.x, a.x)"],
    "void f() { set(a, 1U, g()); }": [],
    "MAMORI_FIELDS(A, first, second)": [],
    "auto t = mamori::parts(\n    react(a),\n    react(b));": ["(\n    \nreact(b))", "(\n    react(a)\n)"],
    "auto t = faults<F::kA, F::kB, F::kC>();": ["<F::kB, F::kA, F::kC>", "<F::kA, F::kC, F::kB>", "<F::kB, F::kC>", "<F::kA, F::kC>",
                                             "<F::kA, F::kB>", "<F::kB, F::kB, F::kC>", "<F::kA, F::kC, F::kC>", "<F::kA, F::kB, F::kA>"],
    "F f(F a) { switch (a) { case F::kA: return F::kB; } return F::kC; }": ["return F::kC; }", "return F::kB; }"],
}  # fmt: skip


def list_changes(text: str, file: str = "a.cpp") -> list[str]:
    source = text.encode("utf-8")
    return [mutant.apply(source).decode("utf-8") for mutant in make_mutants(file, source)]


@pytest.mark.parametrize("text", WIRING)
@pytest.mark.verifies("SWR-VER-033", technique="equivalence_classes")
def test_example_has_changes_of_limits_and_wiring_too(text: str) -> None:
    others = list_changes(text)
    changes = [change for change in list_changes(text, "examples/a/a.cpp") if change not in others]

    assert [wanted for wanted in WIRING[text] if not any(wanted in change for change in changes)] == []
    assert len(changes) == len(WIRING[text]), changes
    assert {change.count("\n") for change in changes} <= {text.count("\n")}


@pytest.mark.parametrize("text", CHANGES)
@pytest.mark.verifies("SWR-VER-004", technique="equivalence_classes")
def test_each_operator_makes_its_changes_and_no_others(text: str) -> None:
    changes = list_changes(text)

    assert len(changes) == len(CHANGES[text])
    assert [wanted for wanted in CHANGES[text] if not any(wanted in change for change in changes)] == []


@pytest.mark.parametrize(
    "text",
    ["// a < b\n", "#define LIMIT 3\n", '#include "a.hpp"\n', "static_assert(1 < 2);", "template <int N = 3> struct A;",
     "std::array<int, 8U> a;", "bool operator<(A a, A b);"],
)  # fmt: skip
@pytest.mark.verifies("SWR-VER-004", technique="error_guessing")
def test_text_that_decides_nothing_at_run_time_is_left_alone(text: str) -> None:
    assert list_changes(text) == []


@pytest.mark.verifies("SWR-VER-004", technique="interface")
def test_change_keeps_the_number_of_lines() -> None:
    text = "void f() {\n    call(a,\n         b);\n    if (a ||\n        b()) {\n        return;\n    }\n}\n"

    assert {change.count("\n") for change in list_changes(text)} == {text.count("\n")}
