# SPDX-License-Identifier: Apache-2.0
# Goal: the stack of every entry point has a proven bound, and a run on the controller stays below it; code that hides stack from the proof
# is found. Method: the image of verification/proofs/target, for controller and host, and seeded sources that must be rejected with
# function, file and line.
from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT, Project
from mamori_trace.base.errors import WorkError
from verification.proofs.call_graph import OutsideRow, PointerRow, Rules, read_rules, split_signature
from verification.proofs.depth import calc_deepest_paths, find_groups
from verification.proofs.image import Run, check_watermark, get_stack_size, link_image, run_in_qemu, run_on_host
from verification.proofs.library_code import calc_library_bounds
from verification.proofs.stack import Analysis, analyse, analyse_image, main, make_table, write_evidence
from verification.proofs.symbols import count_symbols, scan_sections, scan_symbols
from verification.proofs.toolchain import CORTEX_M4, HOST, HOST_AS_WRITTEN, Toolchain, Unit, compile_units

EXCEPTION_FRAME_BYTES = 8 * 4 + 4  # eight registers plus alignment, without floating-point unit
EVERY_TOOLCHAIN = pytest.mark.parametrize("toolchain", [CORTEX_M4, HOST], ids=lambda toolchain: toolchain.name)
Judge = Callable[..., Analysis]


@dataclass(frozen=True)
class Built:
    """The image for the controller, and the analyses of its controller and host versions."""

    analyses: dict[str, Analysis]
    units: dict[str, list[Unit]]
    image: Path

    @property
    def controller(self) -> Analysis:
        return self.analyses[CORTEX_M4.name]

    @property
    def bound(self) -> int | None:
        return self.controller.get_bound("reset_handler")


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    folder = tmp_path_factory.mktemp("stack")
    pairs = {one.name: analyse_image(one, ROOT, folder / one.name) for one in (CORTEX_M4, HOST)}
    units = {name: pair[1] for name, pair in pairs.items()}
    image = link_image(ROOT, units[CORTEX_M4.name], folder / "image.elf")
    return Built({name: pair[0] for name, pair in pairs.items()}, units, image)


@pytest.fixture(scope="session")
def run(built: Built) -> Run:
    return run_in_qemu(built.image)


@pytest.fixture
def judge(tmp_path: Path) -> Judge:
    """Analyses one seeded source."""

    def analyse_text(text: str, *rows: PointerRow | OutsideRow, toolchain: Toolchain = CORTEX_M4) -> Analysis:
        (tmp_path / "seeded.cpp").write_text(text, encoding="utf-8")
        units = compile_units(toolchain, tmp_path, ["seeded.cpp"], [], tmp_path / "out")
        rules = Rules(tuple(row for row in rows if isinstance(row, PointerRow)),
                      tuple(row for row in rows if isinstance(row, OutsideRow)))  # fmt: skip
        return analyse(toolchain, tmp_path, units, rules)

    return analyse_text


# ---- SWR-PRF-020: a bound for every entry point ----------------------------------------------------------------------------


@EVERY_TOOLCHAIN
@pytest.mark.verifies("SWR-PRF-020")
def test_every_function_of_the_image_has_a_bound(built: Built, toolchain: Toolchain) -> None:
    analysis = built.analyses[toolchain.name]

    assert [str(finding) for finding in analysis.findings] == []
    assert sorted(analysis.graph.functions.keys() - analysis.paths.keys()) == []


@EVERY_TOOLCHAIN
@pytest.mark.verifies("SWR-PRF-020", technique="error_guessing")
def test_executive_and_components_are_among_the_entry_points(built: Built, toolchain: Toolchain) -> None:
    analysis = built.analyses[toolchain.name]
    names = {split_signature(analysis.graph.functions[entry.key].name)[0] for entry in analysis.entries}

    assert {"mamori::Executive::start", "mamori::Executive::run_window", "mamori::safety::SafetyCycle::on_execute"} <= names
    assert {"executive", "component", "program"} <= {entry.kind for entry in analysis.entries}


@pytest.mark.verifies("SWR-PRF-020")
def test_bound_is_the_sum_of_the_frames_on_the_deepest_path(judge: Judge) -> None:
    text = """
    void use(volatile char*);
    [[gnu::noinline]] int leaf() { volatile char a[64]; a[0] = 1; return a[0]; }
    [[gnu::noinline]] int deep() { volatile char a[256]; a[0] = 1; return a[0] + leaf(); }
    int top(bool b) { volatile char a[32]; a[0] = 1; return (b ? deep() : leaf()) + a[0]; }
    """
    analysis = judge(text)
    functions = analysis.graph.functions

    assert analysis.paths["_Z3topb"] == ("_Z3topb", "_Z4deepv", "_Z4leafv")
    assert analysis.get_bound("_Z3topb") == sum(functions[key].bytes for key in ("_Z3topb", "_Z4deepv", "_Z4leafv"))
    assert 64 + 256 + 32 <= (analysis.get_bound("_Z3topb") or 0) <= 64 + 256 + 32 + 3 * 40


@pytest.mark.parametrize(
    "body", ["char* p = static_cast<char*>(__builtin_alloca(n));", "char p[n];"], ids=["alloca", "array"]
)
@EVERY_TOOLCHAIN
@pytest.mark.verifies("SWR-PRF-020", technique="fault_injection", polarity="violation")
def test_seeded_frame_that_grows_is_found(judge: Judge, toolchain: Toolchain, body: str) -> None:
    text = f'\nvoid grow(int n) {{\n    {body}\n    asm volatile("" : : "r"(p) : "memory");\n}}\n'
    (finding,) = judge(text, toolchain=toolchain).findings

    assert str(finding).startswith("seeded.cpp:2:6: frame: grow(int): its frame grows at run time")


@pytest.mark.verifies("SWR-PRF-020", technique="interface")
def test_evidence_tells_bounds_and_paths(built: Built, run: Run) -> None:
    folder = Project(ROOT).evidence
    write_evidence(list(built.analyses.values()), folder,
                   watermark={"bound_bytes": built.bound, "used_bytes": run.stack_used_bytes})  # fmt: skip
    record = json.loads((folder / "stack.json").read_text(encoding="utf-8"))

    for name in built.analyses:
        assert record[name]["findings"] == []
        for entry in record[name]["entries"]:
            frames = sum(step["frame_bytes"] for step in entry["path"])
            assert entry["bound_bytes"] == frames + record[name]["red_zone_bytes"]
    assert "Executive::run_window" in (folder / "stack.txt").read_text(encoding="utf-8")


@pytest.mark.verifies("SWR-PRF-020", technique="error_guessing", polarity="violation")
def test_source_that_does_not_compile_proves_nothing(judge: Judge) -> None:
    with pytest.raises(WorkError, match=r"seeded.cpp"):
        judge("int f( {\n")


# ---- SWR-PRF-021: indirect calls -------------------------------------------------------------------------------------------

SHAPES = """
struct A { virtual int f(int) = 0; virtual int g() { return 1; } protected: ~A() = default; };
struct B { virtual int h(int) = 0; protected: ~B() = default; };
struct C : A, B { int f(int a) override; int h(int) override; int x{1}; protected: ~C() = default; };
int C::f(int a) { volatile char b[100]; b[0] = 1; return a + x + b[0]; }
int C::h(int a) { volatile char b[200]; b[0] = 1; return a + x + b[0]; }
namespace {
template <typename T> struct D final : C {
    int h(int a) override { volatile char b[300]; b[0] = 1; return T(a) + b[0]; }
};
}
D<short> d;
A& get() { return d; }
"""
POINTER = "int call(int (*p)(int), int a) {\n    return p(a) + 1;\n}\n"
TARGET = "int twice(int a) { return 2 * a; }\nint (*g_p)(int) = &twice;\n"
ROW = PointerRow("seeded.cpp", "p(a)", "int", "for the test")


@EVERY_TOOLCHAIN
@pytest.mark.verifies("SWR-PRF-021")
def test_every_indirect_call_of_the_image_has_targets(built: Built, toolchain: Toolchain) -> None:
    analysis = built.analyses[toolchain.name]

    assert len(analysis.graph.resolved) >= 30
    assert all(call.targets for call in analysis.graph.resolved)
    assert [str(finding) for finding in analysis.findings if finding.rule in ("indirect call", "unused row")] == []


@EVERY_TOOLCHAIN
@pytest.mark.verifies("SWR-PRF-021", technique="equivalence_classes")
def test_virtual_call_reaches_every_override_and_nothing_else(judge: Judge, toolchain: Toolchain) -> None:
    calls = "int call(A& a) { return a.f(1) + 1; }\nint call(B& b) { return b.h(1) + 1; }\n"
    analysis = judge(SHAPES + calls, toolchain=toolchain)
    names = {call.how: {analysis.graph.functions[key].name for key in call.targets} for call in analysis.graph.resolved}

    assert [str(finding) for finding in analysis.findings] == []
    assert names["virtual 0 of A"] == {"C::f(int)"}
    # Call through the second base: thunks, which jump to the functions themselves.
    assert names["virtual 0 of B"] == {"non-virtual thunk to C::h(int)",
                                       "non-virtual thunk to (anonymous namespace)::D<short>::h(int)"}  # fmt: skip
    assert 300 <= (analysis.get_bound("_Z4callR1B") or 0) < 400


@EVERY_TOOLCHAIN
@pytest.mark.verifies("SWR-PRF-021")
def test_pointer_reaches_every_function_with_its_parameters(judge: Judge, toolchain: Toolchain) -> None:
    other = "void other(char) {}\nvoid (*g_other)(char) = &other;\nvoid call() { g_other('a'); asm volatile(\"\"); }\n"
    analysis = judge(POINTER + TARGET + other, ROW, replace(ROW, call="g_other('a')", parameters="char"), toolchain=toolchain)

    assert [str(finding) for finding in analysis.findings] == []
    assert {call.how: call.targets for call in analysis.graph.resolved} == {
        "pointer to (int)": ("_Z5twicei",), "pointer to (char)": ("_Z5otherc",)}  # fmt: skip


@EVERY_TOOLCHAIN
@pytest.mark.verifies("SWR-PRF-021", technique="fault_injection", polarity="violation")
def test_seeded_pointer_without_row_is_found(judge: Judge, toolchain: Toolchain) -> None:
    (finding,) = judge(POINTER, toolchain=toolchain).findings

    assert str(finding).startswith("seeded.cpp:2:")
    assert "call(int (*)(int), int): 'return p(a) + 1;' calls through a pointer, and no row tells" in str(finding)


SEEDED_POINTERS = {
    "no such function": ((POINTER, (ROW,)), "takes the address of no function with the parameters 'int'"),
    "row without call": (("int f() { return 1; }\n", (ROW,)), "no indirect call is in a line with 'p(a)'"),
    "wrong parameters": ((POINTER + TARGET, (replace(ROW, parameters="char"),)), "takes the address of twice(int)"),
    "function that nothing calls": ((TARGET, ()), "takes the address of twice(int)"),
    "two rows": ((POINTER + TARGET, (ROW, replace(ROW, call="return p"))), "no one row for one call"),
    "member": (("struct A { int f(int a) { return a; } };\nint call(A& a, int (A::*p)(int)) { return (a.*p)(1) + 1; }\n", ()),
               "no row tells"),
    "interface without class": (("struct A { virtual int f() = 0; protected: ~A() = default; };\n"
                                 "int call(A& a) { return a.f() + 1; }\n", ()), "which no class of the image overrides"),
}  # fmt: skip


@pytest.mark.parametrize("name", SEEDED_POINTERS)
@pytest.mark.verifies("SWR-PRF-021", technique="fault_injection", polarity="violation")
def test_seeded_gap_is_found(judge: Judge, name: str) -> None:
    (text, rows), message = SEEDED_POINTERS[name]
    findings = [str(finding) for finding in judge(text, *rows).findings]

    assert any(message in finding for finding in findings), findings


# ---- SWR-PRF-022: recursion ------------------------------------------------------------------------------------------------

RECURSIONS = {
    "direct": ("int f(int a) {\n    int b[9];\n    b[a % 9] = a;\n    return a > 0 ? f(a - 1) + b[a % 9 / 2] : 0;\n}\n", "f(int)"),
    "tail": ("int f(int a) { return a > 0 ? f(a - 1) : 0; }\n", "f(int)"),
    "mutual": ("int g(int);\nint f(int a) { return a > 0 ? g(a - 1) + 1 : 0; }\nint g(int a) { return f(a - 2) + 2; }\n",
               "g(int)"),
    "virtual": ("struct A { virtual int f(int) = 0; protected: ~A() = default; };\n"
                "struct B final : A { A* next; int f(int a) override; };\nint B::f(int a) { return next->f(a) + 1; }\nB b;\n",
                "B::f(int)"),
}  # fmt: skip


@pytest.mark.verifies("SWR-PRF-022")
def test_nothing_recurs_as_compiled(built: Built) -> None:
    for analysis in built.analyses.values():
        assert [str(finding) for finding in analysis.findings if finding.rule == "recursion"] == []


@pytest.mark.verifies("SWR-PRF-022")
def test_nothing_recurs_as_written(tmp_path: Path) -> None:
    # Without optimisation: otherwise the compiler may turn a recursive tail call into a loop, or inline a step of a recursion.
    analysis, _ = analyse_image(HOST_AS_WRITTEN, ROOT, tmp_path)

    assert len(analysis.graph.functions) > 200
    assert [str(finding) for finding in analysis.findings if finding.rule in ("recursion", "indirect call")] == []


@pytest.mark.parametrize("name", RECURSIONS)
@pytest.mark.verifies("SWR-PRF-022", technique="fault_injection", polarity="violation")
def test_seeded_recursion_is_found(judge: Judge, name: str) -> None:
    text, function = RECURSIONS[name]
    analysis = judge(text, toolchain=HOST_AS_WRITTEN)
    (finding,) = [finding for finding in analysis.findings if finding.rule == "recursion"]

    assert finding.place.startswith("seeded.cpp:")
    assert function in finding.message
    assert "_Z1fi" not in analysis.paths


@pytest.mark.verifies("SWR-PRF-022", technique="equivalence_classes")
def test_groups_and_paths_of_a_small_graph() -> None:
    calls = {"a": {"b", "c"}, "b": {"d"}, "c": {"d"}, "d": set(), "e": {"f"}, "f": {"e"}, "g": {"e"}, "h": {"h"}}

    assert [group for group in find_groups(calls) if len(group) > 1] == [["e", "f"]]
    assert calc_deepest_paths(dict.fromkeys(calls, 1) | {"c": 5}, calls) == {
        "a": ("a", "c", "d"), "b": ("b", "d"), "c": ("c", "d"), "d": ("d",)}  # fmt: skip


# ---- SWR-PRF-023: functions without a compiler frame size ------------------------------------------------------------------


def list_for_controller() -> dict[str, int]:
    return {row.function: row.bytes for row in read_rules().outside if row.toolchain == CORTEX_M4.name}


@pytest.mark.verifies("SWR-PRF-023")
def test_listed_functions_take_no_more_than_the_list_says(built: Built) -> None:
    listed = list_for_controller()
    found = calc_library_bounds(built.image, list(listed))

    assert {name: size for name, size in found.items() if size > listed[name]} == {}


@pytest.mark.verifies("SWR-PRF-023", technique="fault_injection", polarity="violation")
def test_function_that_takes_more_than_the_list_says_is_found(built: Built, tmp_path: Path) -> None:
    image = link_hungry(built, tmp_path)

    assert calc_library_bounds(image, ["memset"])["memset"] > list_for_controller()["memset"]


@pytest.mark.verifies("SWR-PRF-023", technique="fault_injection", polarity="violation")
def test_stack_of_unknown_size_in_listed_code_is_refused(built: Built, tmp_path: Path) -> None:
    image = link_hungry(built, tmp_path, "sub sp, sp, r2")

    with pytest.raises(WorkError, match=r"memset: 'sub.w sp, sp, r2' changes the stack pointer"):
        calc_library_bounds(image, ["memset"])


@EVERY_TOOLCHAIN
@pytest.mark.verifies("SWR-PRF-023", technique="fault_injection", polarity="violation")
def test_seeded_call_of_an_unknown_function_is_found(judge: Judge, toolchain: Toolchain) -> None:
    (finding,) = judge("void far(int);\nint f(int a) {\n    far(a);\n    return 1;\n}\n", toolchain=toolchain).findings

    assert str(finding).startswith("seeded.cpp:2:5: outside: f(int) calls _Z3fari: the compiler knows no frame of it")


@pytest.mark.verifies("SWR-PRF-023", technique="fault_injection", polarity="violation")
def test_seeded_assembler_function_is_found(judge: Judge) -> None:
    text = 'asm(".section .text.far\\n.type far, %function\\nfar: bx lr\\n.size far, . - far\\n.text\\n");\nint f() { return 1; }\n'
    (finding,) = judge(text).findings

    assert finding.rule == "outside"
    assert "far: the compiler knows no frame" in str(finding)


@pytest.mark.verifies("SWR-PRF-023", technique="equivalence_classes")
def test_listed_function_counts_with_its_bytes(judge: Judge) -> None:
    text = 'extern "C" void far(int);\nint f(int a) {\n    far(a);\n    return 1;\n}\n'
    analysis = judge(text, OutsideRow(CORTEX_M4.name, "far", 1000, "for the test"))

    assert [str(finding) for finding in analysis.findings] == []
    assert 1000 < (analysis.get_bound("_Z1fi") or 0) < 1020


@pytest.mark.verifies("SWR-PRF-023", technique="fault_injection", polarity="violation")
def test_listed_function_that_nothing_calls_is_found(judge: Judge) -> None:
    (finding,) = judge("int f() { return 1; }\n", OutsideRow(CORTEX_M4.name, "far", 8, "for the test")).findings

    assert str(finding) == "stack.toml: unused row: cortex-m4: nothing calls far; remove it"


# ---- SWR-PRF-024: the measured watermark -----------------------------------------------------------------------------------

HUNGRY = """
extern "C" [[gnu::naked]] void* memset(void*, int, unsigned) {
    asm volatile(
        "mov r3, r0\\n"
        "sub.w sp, sp, #2048\\n"
        "str r1, [sp]\\n"
        "add.w sp, sp, #2048\\n"
        "1: cbz r2, 2f\\n"
        "strb r1, [r3], #1\\n"
        "subs r2, #1\\n"
        "b 1b\\n"
        "2: bx lr\\n"
        "MORE\\n");
}
"""


def link_hungry(built: Built, folder: Path, more: str = "") -> Path:
    """The image with an unlisted memset that uses 2 kB of stack."""
    (folder / "hungry.cpp").write_text(HUNGRY.replace("MORE", more), encoding="utf-8")
    (unit,) = compile_units(CORTEX_M4, folder, ["hungry.cpp"], [], folder)
    return link_image(ROOT, [*built.units[CORTEX_M4.name], unit], folder / "hungry.elf")


@pytest.mark.verifies("SWR-PRF-024")
def test_run_on_the_controller_stays_below_the_bound(built: Built, run: Run) -> None:
    assert check_watermark(built.bound, run.stack_used_bytes) == ""


@pytest.mark.verifies("SWR-PRF-024")
def test_run_on_the_controller_saw_operation_faults_and_overruns(run: Run) -> None:
    # Otherwise the measured stack would be that of an idle system.
    assert run.frames == 2000
    assert run.operational_frames > 100
    assert run.overruns > 0
    assert run.latched_faults >= 2


@pytest.mark.verifies("SWR-PRF-024", technique="fault_injection", polarity="violation")
def test_run_above_the_bound_is_found(built: Built, tmp_path: Path) -> None:
    used = run_in_qemu(link_hungry(built, tmp_path)).stack_used_bytes

    assert f"used {used} bytes of stack, {used - (built.bound or 0)} more than" in check_watermark(built.bound, used)


@pytest.mark.parametrize(("bound", "used", "is_right"), [(100, 100, True), (100, 101, False), (100, 0, False), (None, 1, False)])
@pytest.mark.verifies("SWR-PRF-024", technique="boundary_values", polarity="violation")
def test_bound_and_watermark_are_judged_at_their_limits(bound: int | None, used: int, is_right: bool) -> None:
    assert (check_watermark(bound, used) == "") == is_right


@pytest.mark.verifies("SWR-PRF-024")
def test_stack_of_the_image_holds_the_bound_and_a_fault_on_top(built: Built) -> None:
    faults = [built.controller.get_bound(entry.key) or 0 for entry in built.controller.entries if entry.kind == "vector"]

    assert faults
    assert (built.bound or 0) + EXCEPTION_FRAME_BYTES + max(faults) <= get_stack_size(built.image)


@pytest.mark.verifies("SWR-PRF-024", technique="error_guessing", polarity="violation")
def test_run_without_a_whole_record_is_refused(tmp_path: Path) -> None:
    silent = tmp_path / "silent"
    silent.write_text("#!/bin/sh\nexit 0\n", encoding="utf-8")
    silent.chmod(0o755)

    with pytest.raises(WorkError, match="told no whole record"):
        run_on_host(silent)


# ---- SWR-PRF-027, SWR-PRF-028: the linked image ----------------------------------------------------------------------------


@pytest.mark.verifies("SWR-PRF-027")
def test_linked_image_has_neither_heap_nor_exceptions_nor_code_before_main(built: Built) -> None:
    assert count_symbols(built.image, CORTEX_M4.prefix) > 0
    assert [str(finding) for finding in scan_symbols(built.image, CORTEX_M4.prefix)] == []
    assert [str(finding) for finding in scan_sections(built.image, CORTEX_M4.prefix)] == []


@pytest.mark.parametrize(
    ("text", "message"),
    [("int f();\nint g = f();\nint f() { int a; asm volatile(\"\" : \"=r\"(a)); return a; }\n", "the image has dynamic initialisation"),
     ('#include <cstdlib>\nextern "C" [[gnu::used, gnu::section(".vectors")]] void* (*const use)(std::size_t) = &std::malloc;\n',
      "the image links a heap")],
    ids=["initialiser", "heap"],
)  # fmt: skip
@pytest.mark.verifies("SWR-PRF-027", technique="fault_injection", polarity="violation")
def test_image_with_a_seeded_violation_does_not_link(built: Built, tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "seeded.cpp").write_text(text, encoding="utf-8")
    (unit,) = compile_units(CORTEX_M4, tmp_path, ["seeded.cpp"], [], tmp_path)

    with pytest.raises(WorkError, match=message):
        link_image(ROOT, [*built.units[CORTEX_M4.name], unit], tmp_path / "image.elf")


@pytest.mark.verifies("SWR-PRF-028", technique="back_to_back")
def test_controller_and_host_give_one_hash(built: Built, run: Run, tmp_path: Path) -> None:
    host = run_on_host(link_image(ROOT, built.units[HOST.name], tmp_path / "host", HOST))

    assert host.frames == run.frames
    assert host.trace_hash == run.trace_hash


# ---- The command -----------------------------------------------------------------------------------------------------------


@pytest.mark.verifies("SWR-PRF-020", technique="interface")
def test_table_names_the_findings(judge: Judge) -> None:
    assert "calls through a pointer" in make_table([judge(POINTER)])


@pytest.mark.verifies("SWR-PRF-020", technique="error_guessing", polarity="violation")
def test_command_refuses_a_wrong_option(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["--output", "x"])
    assert "--output" in capsys.readouterr().err
