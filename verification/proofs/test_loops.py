# SPDX-License-Identifier: Apache-2.0
# Goal: each loop of the target layers has a bound, and no goto exists; seeded violations are found with function, file and line.
from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT, Project
from verification.proofs.loops import Loop, LoopFinding, LoopRow, check_loops, find_files, find_loops, main, make_record, read_rows

ROW = LoopRow("seeded.cpp", "f", "n > 1", "64 rounds", "n loses a bit in each")
UNBOUNDED = {
    "while": ("while (n > 1) { n /= 2; }", "n > 1"),
    "do": ("do { n /= 2; } while (n > 1);", "n > 1"),
    "for ever": ("for (;;) { n /= 2; }", "; ; "),
    "no bound": ("for (int i = 0; ; ++i) { n += i; }", "int i = 0; ; ++i"),
    "other end": ("for (int i = 0; i != n; ++i) {}", "int i = 0; i != n; ++i"),
    "step of unknown size": ("for (int i = 0; i < 9; i += n) {}", "int i = 0; i < 9; i += n"),
    "wrong way down": ("for (int i = 9; i > 0; ++i) {}", "int i = 9; i > 0; ++i"),
    "down by two": ("for (unsigned i = 9; i > 0; i -= 2) {}", "unsigned i = 9; i > 0; i -= 2"),
    "constant less": ("for (unsigned i = 0; i - 1 < n; ++i) {}", "unsigned i = 0; i - 1 < n; ++i"),
    "wrong way": ("for (int i = 0; i < 9; --i) {}", "int i = 0; i < 9; --i"),
    "counter set back": ("for (int i = 0; i < 9; ++i) { i = 0; }", "int i = 0; i < 9; ++i"),
    "counter lent": ("for (int i = 0; i < 9; ++i) { g(&i); }", "int i = 0; i < 9; ++i"),
    "bound moves": ("for (int i = 0; i < n; ++i) { ++n; }", "int i = 0; i < n; ++i"),
    "bound of a member moves": ("for (int i = 0; i < a.n; ++i) { a.n = n; }", "int i = 0; i < a.n; ++i"),
    "narrow counter": ("for (unsigned char i = 0; i < n; ++i) {}", "unsigned char i = 0; i < n; ++i"),
    "either ends": ("for (int i = 0; i < 9 || n; ++i) {}", "int i = 0; i < 9 || n; ++i"),
}
BOUNDED = {
    "range": "for (int a : b) { n += a; }",
    "counted": "for (int i = 0; i < n; ++i) { b[i] = 0; }",
    "counted by two": "for (int i = 0; i < 9; i += 2) {}",
    "counted, may end early": "for (int i = 0; i < n && b[i]; i++) { n2 = i; }",
    "counted with a constant more": "for (int i = 0; n2 && i + 1 < n; ++i) {}",
    "counted down to zero": "for (int i = n; i > 0; --i) { b[i] = 0; }",
    "counted down": "for (int i = n; i-- > 0;) { b[i] = 0; }",
}


def judge(folder: Path, code: str, *rows: LoopRow) -> list[LoopFinding]:
    source = folder / "seeded.cpp"
    source.write_text(code, encoding="utf-8")
    loops, findings = find_loops(folder, [source])
    return findings + check_loops(loops, rows)


@pytest.mark.verifies("SWR-PRF-025")
def test_every_loop_of_the_target_layers_has_a_bound() -> None:
    files = find_files(ROOT)
    loops, findings = find_loops(ROOT, files)
    rows = read_rows()
    findings += check_loops(loops, rows)
    Project(ROOT).evidence.mkdir(parents=True, exist_ok=True)
    record = json.dumps(make_record(loops, rows, findings), indent=1)
    (Project(ROOT).evidence / "loops.json").write_text(record + "\n", encoding="utf-8")

    assert [str(finding) for finding in findings] == []
    for layer in ("kernel", "safety"):
        assert any(loop.file.startswith(f"{layer}/src/") for loop in loops)
        assert any(loop.file.startswith(f"{layer}/include/") for loop in loops)


@pytest.mark.parametrize("name", BOUNDED)
@pytest.mark.verifies("SWR-PRF-025")
def test_bound_that_the_form_shows_is_seen(tmp_path: Path, name: str) -> None:
    assert judge(tmp_path, f"int f(int n) {{\n{BOUNDED[name]}\nreturn n; }}\n") == []


@pytest.mark.parametrize("name", UNBOUNDED)
@pytest.mark.verifies("SWR-PRF-025", technique="fault_injection", polarity="violation")
def test_seeded_loop_without_bound_is_found(tmp_path: Path, name: str) -> None:
    code, condition = UNBOUNDED[name]
    (finding,) = judge(tmp_path, f"struct A {{ int f(int n) {{\n{code}\nreturn n; }} }};\n")

    assert str(finding).startswith(f"seeded.cpp:2: loop: A::f: the form of '{condition}' shows no bound")


@pytest.mark.verifies("SWR-PRF-025", technique="fault_injection", polarity="violation")
def test_loop_in_a_macro_is_found(tmp_path: Path) -> None:
    (finding,) = judge(tmp_path, "// for show\n#define SPIN(n) while (n) {}\nint f(int n) { SPIN(n) return n; }\n")

    assert str(finding).startswith("seeded.cpp:2: loop: 'while'")


@pytest.mark.verifies("SWR-PRF-025", technique="equivalence_classes")
def test_listed_loop_is_accepted_for_its_row(tmp_path: Path) -> None:
    assert judge(tmp_path, "int f(int n) {\nwhile (n > 1) { n /= 2; }\nreturn n; }\n", ROW) == []


@pytest.mark.parametrize(
    "code",
    ["int f(int n) { return n; }", "int g(int n) { while (n > 1) { n /= 2; } return n; }",
     "int f(int n) { while (n > 2) { n /= 2; } return n; }", "int f(int n) { for (int i = 0; i < n; ++i) {} return n; }"],
    ids=["no loop", "other function", "other condition", "bounded loop"],
)  # fmt: skip
@pytest.mark.verifies("SWR-PRF-025", technique="fault_injection", polarity="violation")
def test_row_without_its_loop_is_found(tmp_path: Path, code: str) -> None:
    assert ("seeded.cpp", "unused row") in {(finding.file, finding.rule) for finding in judge(tmp_path, code, ROW)}


@pytest.mark.verifies("SWR-PRF-025", technique="boundary_values", polarity="violation")
def test_row_for_two_loops_is_found(tmp_path: Path) -> None:
    loop = Loop("seeded.cpp", 3, "f", "while", "n > 1")
    (finding,) = check_loops([loop, dataclasses.replace(loop, line=7)], [ROW])

    assert "lines 3, 7" in str(finding)


@pytest.mark.verifies("SWR-PRF-026")
def test_no_target_layer_jumps() -> None:
    _, findings = find_loops(ROOT, find_files(ROOT))

    assert [str(finding) for finding in findings if finding.rule == "goto"] == []


@pytest.mark.verifies("SWR-PRF-026", technique="fault_injection", polarity="violation")
def test_seeded_goto_is_found(tmp_path: Path) -> None:
    findings = judge(tmp_path, "int f(int n) {\nagain:\n  if (n-- > 1) {\n    goto again;\n  }\n  return n;\n}\n")

    assert [str(finding).partition(";")[0] for finding in findings] == ["seeded.cpp:4: goto: f jumps"]


@pytest.mark.verifies("SWR-PRF-025", technique="interface")
def test_command_tells_what_it_saw(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    assert "loops" in capsys.readouterr().out


@pytest.mark.verifies("SWR-PRF-025", technique="error_guessing", polarity="violation")
def test_command_refuses_a_folder_that_is_no_source_tree(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["--root", str(tmp_path)])
    assert "has no folder kernel" in capsys.readouterr().err
