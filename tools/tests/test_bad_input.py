# SPDX-License-Identifier: Apache-2.0
# Goal: bad input of every kind, to every command, ends with the right status and one line, without a traceback or a file change.
# Method: a folder of files with one error each, a table of calls, and a comparison of the folder before and after.
from __future__ import annotations

import os
import re
import subprocess
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import pytest

from mamori_tools.command import demo, verify
from mamori_tools.command.help_texts import make_texts
from mamori_tools.command.main import list_commands, main
from mamori_tools.host.project import ROOT
from verification.plan import command as test_command

DEEP = "[" * 100_000
MOTION = "type: BodyMotion\n"
ITEM = "# Items\n\n## SWR-APP-001 One\n\nThe arm shall stop.\n"
FILES: dict[str, str | bytes] = {
    "empty": b"",
    "white": " \n\t\n",
    "text.txt": "no such thing\n",
    "binary": bytes(range(256)) * 16,
    "latin": "motion: m\xfcde\n".encode("latin-1"),
    "half.json": '{"schema": "mamori',
    "list.json": "[1, 2]",
    "deep.json": DEEP,
    "nan.json": '{"schema": NaN}',
    "huge.json": '{"schema": ' + "9" * 5000 + "}",
    "twice.json": '{"a": 1, "a": 2}',
    "half.yaml": "type: BodyMotion\n  - x: [1\n",
    "deep.yaml": DEEP,
    "bomb.yaml": "a: &a [x, x]\nb: &b [*a, *a]\nc: [*b, *b]\n",
    "keys.yaml": MOTION + "tracks: 3\n",
    "half.toml": "program = [1\n",
    "half.xml": "<testsuite><testcase name='a'>",
    "entity.xml": '<!DOCTYPE x [<!ENTITY a "b">]><REQ-IF>&a;</REQ-IF>',
    "nan.dat": "0 nan nan nan nan nan nan nan\n1 0 0 0 0 0 0 0\n",
    "inf.dat": "0 0 0 0 0 0 0 0\n1e999 0 0 0 0 0 0 0\n",
    "back.dat": "1 0 0 0 0 0 0 0\n0 0 0 0 0 0 0 0\n",
    "short.dat": "0 0 0\n1 0 0\n",
    "huge.dat": "0 0 0 0 0 0 0 0\n1 1e300 0 0 0 0 0 0\n",
    "a b\n.json": "{",
    "folder/inside": "kept\n",
    "lists/CMakeLists.txt": "project(x)\n",
    "robot/CMakeLists.txt": "find_package(mamori CONFIG REQUIRED)\n",
    "robot/bad/timing.toml": "program = [1\n",
    "robot/keys/timing.toml": "colour = 1\n",
    "robot/away/timing.toml": 'program = "../../x"\ntarget = "x"\n',
    "robot/type/timing.toml": "program = 3\n",
    "program": "#!/bin/sh\nexit 0\n",
    "items/requirements/schema/items.toml": "levels = [",
    "good/requirements/README.md": "",
    "bundle/manifest.json": "{",
    "bundle.tar": b"x" * 1024,
}
NAMES = ["absent", "folder", "empty", "white", "text.txt", "binary", "latin", "half.json", "list.json", "deep.json", "nan.json", "huge.json",
         "twice.json", "a b\n.json", "/dev/null", "n" * 300, "no\udcffutf8"]  # fmt: skip
MOTIONS = ["absent", "folder", "empty", "white", "binary", "latin", "half.yaml", "deep.yaml", "bomb.yaml", "keys.yaml", "nan.dat", "inf.dat",
           "back.dat", "short.dat", "huge.dat", "text.txt", "/dev/null", "n" * 300]  # fmt: skip
NUMBERS = ["0", "-1", "1.5", "nan", "1e3", "x", "", "٣", "9" * 400]
FAULTS = ["x", "", ",", "encoder_freeze,joint=8", "encoder_freeze,joint=0", "encoder_freeze,joint", "encoder_freeze,colour=1",
          "encoder_freeze,joint=1,joint=2", "encoder_freeze,at=nan", "encoder_freeze,at=1e999", "encoder_freeze,at=-1", "encoder_freeze,at=9e9",
          "encoder_freeze,channel=c", "none,at=1", "encoder_freeze,duration=0"]  # fmt: skip
E2E = ["--profile", "1", "--length", "8", "--rate", "100", "--pe", "0.01"]


def make_e2e(option: str, value: str) -> list[str]:
    words = list(E2E) if option in E2E else [*E2E, option, ""]
    words[words.index(option) + 1] = value
    return words


Case = tuple[list[str], int]
CALLS: list[Case] = [
    *[(["log", name], 2) for name in NAMES],
    *[(["table", name], 2) for name in NAMES],
    *[(["demo", "--motion", name], 2) for name in MOTIONS],
    *[(["run", "--motion", name], 2) for name in MOTIONS],
    *[(["run", f"--fault={fault}"], 2) for fault in FAULTS],
    *[(["demo", f"--jobs={number}"], 2) for number in NUMBERS],
    *[(["demo", f"--instants={number}"], 2) for number in NUMBERS],
    *[(["timing", "lists", f"--cycles={number}"], 2) for number in NUMBERS],
    *[(["mutate", f"--sample={number}"], 2) for number in NUMBERS],
    *[(["mutate", "--list", f"--seed={number}"], 2) for number in ("1.5", "nan", "x", "")],
    *[(["fuzz", f"--seconds={number}"], 2) for number in NUMBERS],
    *[(["e2e", *make_e2e(option, value)], 2) for option in ("--profile", "--length", "--receivers") for value in NUMBERS],
    *[(["e2e", *make_e2e(option, value)], 2) for option in ("--rate", "--pe") for value in ("0", "-1", "nan", "inf", "x", "", "9" * 400, "1e-999999999")],
    (["e2e", *E2E[2:]], 2),
    *[(["campaign", name], 2) for name in ("absent", "folder", "empty", "half.toml", "binary", "no\udcff", "n" * 300, "")],
    *[(["lcm", "types", name, "--out", "types"], 2) for name in ("absent", "folder", "empty", "text.txt", "no\udcff", "n" * 300)],
    *[(["hil", "--motion", name], 2) for name in MOTIONS],
    *[(["hil", f"{option}={number}"], 2) for option in ("--scenarios", "--kills") for number in NUMBERS],
    *[(["hil", f"--seed={number}"], 2) for number in ("1.5", "nan", "x", "")],
    *[(["hil", "--fault", name], 2) for name in ("encoder_freze", "", "none,none", "no\udcff", "a\nb")],
    *[(["hil", option, word], 2) for option in ("--plant", "--kernel", "--controller") for word in ("", "'open", "absent", "./folder", "no\udcff", "n" * 300)],
    *[(["hil", "--out", name], 2) for name in ("text.txt", "folder")],
    *[(["constraint", text], 2) for text in ("x", "x=1", "(1", "{a:1,a:2}", "1e999", "1,2", "a\nb", "no\udcff", "9" * 400)],
    *[(["constraint", "x<1", f"--elements={number}"], 2) for number in (*NUMBERS, "65535")],
    *[(["constraint", "x<1", f"--type={name}"], 2) for name in ("dubble", "", "a\nb", "no\udcff")],
    *[(["constraint", "x<1", "--type", "Mode", f"--names={names}"], 2) for names in ("", "a,,b", "a,a", "1", "a b", "no\udcff")],
    *[(["profile", action, name], 2) for action in ("check", "show", "find") for name in ("absent", "empty", "binary", "text.txt", "no\udcff", "n" * 300, "")],
    *[(["profile", *words], 2) for words in (["chek", "a"], ["check"], ["diff", "a"], ["convert", "a"], ["check", "folder"], ["check", "/dev/null"])],
    (["constraint", "x<1", "--names", "a"], 2), (["constraint", "x<1", "--type", "1a", "--names", "a"], 2),
    *[([command, "--no-such-option"], 2) for command in ("demo", "run", "test", "build", "verify", "log", "table", "constraint", "bench", "mutate", "timing",
                                                         "cost", "e2e", "hil", "lcm", "profile", "prove", "fuzz", "new", "campaign")],
    *[([command], 2) for command in ("log", "campaign", "table", "constraint", "timing", "cost", "e2e", "lcm", "profile", "prove", "new", "no-such-command",
                                                         "")],
    *[([command, "one", "two", "three"], 2) for command in ("demo", "run", "test", "build", "verify", "log", "table", "timing", "cost", "new")],
    *[(["demo", "--scenario", name], 2) for name in ("encoder_freze", "", "none,none", "no\udcff", "a\nb")],
    *[(["demo", option], 2) for option in ("--jobs", "--motion", "--scenario", "--instants")],
    *[([command, name], 2) for command in ("build", "verify") for name in ("absent", "folder", "text.txt", "a b\n", "no\udcff", "n" * 300, "")],
    (["build", "--preset", "host-relase"], 2), (["build", "--preset", ""], 2), (["build", "lists", "--preset", "../x"], 2),
    (["verify", "lists"], 2),
    *[(["new", name], 2) for name in ("folder", "text.txt", "a b", "A", "1a", "a-b", "", ".", "..", "absent/robot", "text.txt/robot", "no\udcff",
                                      "test", "mamori", "n" * 300, "a\nb", "/dev/null/robot", "/proc/robot", str(ROOT / "robot"))],
    *[([command, name], 2) for command in ("timing", "cost") for name in ("absent", "folder", "lists", "text.txt", "robot/bad", "robot/keys", "robot/type",
                                                                          "robot/away", "n" * 300, "no\udcff", "", "a\nb")],
    (["cost", "program"], 2), (["cost", "examples/safe_arm", "--class", "no-such-class"], 2),
    *[([command, "examples/safe_arm", "--check", name], 2) for command in ("timing", "cost") for name in ("absent", "folder", "empty", "half.toml", "binary")],
    *[([command, "examples/safe_arm", "--accept", name], 2) for command in ("timing", "cost") for name in ("folder", "text.txt/x")],
    *[([command, "examples/safe_arm", "--out", name], 2) for command in ("timing", "cost") for name in ("text.txt", "text.txt/x", "/dev/null", "/proc/x")],
    (["timing", "examples/safe_arm", "--check", "a", "--accept", "b"], 2), (["cost", "examples/safe_arm", "--check", "a", "--accept", "b"], 2),
    *[(["bench", "--only", name], 2) for name in ("no-such-bench", "", "a\nb")],
    *[(["bench", "--only", "e2e", "--out", name], 2) for name in ("text.txt", "text.txt/x", "/proc/x")],
    *[(["mutate", name], 2) for name in ("absent", "folder", "text.txt", "", "no\udcff", "../x")],
    *[(["fuzz", name], 2) for name in ("no_such_harness", "", "a\nb", "../x")],
    (["prove", "no-such-machine"], 2), (["prove", "safe-state", "--defect", "no-such-defect"], 2),
    *[(["prove", "safe-state", "--out", name], 2) for name in ("text.txt", "text.txt/x")],
    *[(["table", "list.json", option, "x"], 2) for option in ("--svg-time-line", "--svg-graph", "--svg-modes", "--out")],
    (["table", "list.json", "--json"], 2), (["table", "list.json", "--json", "--text"], 2),
    (["log", "empty", "--csv", "x", "--json"], 2), (["log", "empty", "--names", "half.json"], 2), (["log", "empty", "--mcap"], 2),
]  # fmt: skip
TRACE: list[Case] = [
    *[([action, "--no-such-option"], 2) for action in ("check", "report", "show", "review", "impact", "init", "new", "query", "bundle", "verify",
                                                       "record", "import", "export")],
    (["no-such-action"], 2), ([], 2),
    *[([action, "--root", root, *words], 2) for root in ("absent", "text.txt", "folder", "items", "no\udcff", "n" * 300) for action, *words in (
        ("check",), ("report",), ("show", "SWR-X-001"), ("review", "--all"), ("query", "id ~ SWR"), ("bundle", "--out", "out.tar"),
        ("impact", "HEAD"), ("new", "SWR", "--area", "APP", "--parents", "SYS-001"), ("export", "csv", "--out", "out.csv"))],
    *[(["init", "--root", root], 2) for root in ("absent", "text.txt", "items", "n" * 300)],
    *[(["check", "--root", "good", "--date", day], 2) for day in ("2026-13-01", "today", "", "9" * 400)],
    (["check", "--root", "good", "--output", "xml"], 2), (["check", "--root", "good", "--release", "--allow-missing"], 2),
    *[(["check", "--root", "good", "--evidence", name], 2) for name in ("absent", "text.txt", "n" * 300)],
    *[(["query", "--root", "good", text], 2) for text in ("", "(", "id ~", "id ~ [", "colour = red", "and", "(" * 5000 + ")" * 5000)],
    *[(["verify", name], 2) for name in ("absent", "empty", "text.txt", "folder", "bundle", "bundle.tar", "binary", "/dev/null", "n" * 300)],
    *[(["import", kind, name, "--root", "good", "--into", "good/requirements/x"], 2) for kind in ("csv", "reqif", "doorstop", "no-such-kind")
      for name in ("absent", "empty", "binary", "half.xml", "entity.xml", "folder")],
    *[(["check", "--format", kind, name], 2) for kind in ("csv", "reqif", "sdoc", "trlc", "oft", "no-such-kind") for name in ("absent", "n" * 300)],
    *[(["export", kind, "--root", "good", "--out", name], 2) for kind in ("csv", "reqif") for name in ("folder", "text.txt/x", "/dev/full", "/proc/x")],
    *[(["record", "--root", "good", "--results", "*.xml", "--", *command], status) for command, status in ((["no-such-program"], 3), (["./text.txt"], 3),
                                                                                                   (["./folder"], 3))],
    (["record", "--results", "*.xml"], 2), (["record", "--root", "good", "--results", "x", "--source", "absent", "--", "true"], 2),
]  # fmt: skip
LAUNCHER: list[Case] = [
    (["no-such-command"], 2), (["biuld"], 2), (["demo", "--no-such"], 2), (["demo", "--motion", "absent"], 2), (["demo", "--jobs", "-1"], 2),
    (["run", "--motion=absent"], 2), (["mutate", "--sample", "-5"], 2), (["no\udcff"], 2), (["a\nb"], 2), (["build", "--preset\n"], 2),
    (["log", "--csv", "--x"], 2), (["new", "--name", "x"], 2),
]  # fmt: skip


def make_folder(base: Path) -> Path:
    for name, content in FILES.items():
        path = base / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    (base / "program").chmod(0o755)
    (base / os.fsdecode(b"no\xffutf8")).write_text("{", encoding="utf-8")
    return base


def read_tree(folder: Path) -> dict[str, tuple[int, int, int]]:
    """Values that change when any file in it is written."""
    return {str(path): (path.stat().st_ino, path.stat().st_size, path.stat().st_mtime_ns * path.is_file()) for path in folder.rglob("*")}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_folder(tmp_path_factory.mktemp("bad"))


@pytest.fixture(autouse=True)
def no_work(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Checks that each call ends before the work begins; no call waits for the lock of the checkout."""
    real = subprocess.Popen.__init__

    def start(self: object, words: Any, *more: Any, **options: Any) -> None:
        if words[0] in ("cmake", "ctest", "ninja"):
            raise AssertionError(f"the work began: {words}")
        real(self, words, *more, **options)  # type: ignore[call-overload]

    def begin(*_: object) -> None:
        raise AssertionError("the work began")

    monkeypatch.setattr(subprocess.Popen, "__init__", start)
    for module in (demo, verify, test_command):
        monkeypatch.setattr(module, "begin", begin)
    monkeypatch.setattr("mamori_tools.command.main.raise_on_signals", lambda: None)
    monkeypatch.setattr("mamori_tools.command.main.hold_locks", lambda *_: nullcontext())
    monkeypatch.chdir(folder)


def names_culprit(words: list[str], said: str) -> bool:
    """Whether the line contains a given word (shortened to fit a line) or the missing part."""
    given = words[2 if words[:1] == ["trace"] else 1 :] or words
    parts = {part[:8] for word in given for part in re.split(r"[=/\s]+", word.encode("utf-8", "backslashreplace").decode()) if part}
    return not parts or "required" in said or ("" in given and "''" in said) or any(part in said for part in parts)


def check_refusal(words: list[str], status: int, done: tuple[int, str, str], folder: Path, before: dict[str, tuple[int, int, int]]) -> None:
    found, shown, said = done
    assert found == status, said
    assert shown == ""
    assert said.startswith("mamori") and said.endswith("\n") and len(said.splitlines()) == 1, said
    assert names_culprit(words, said), said
    assert "Traceback" not in said
    assert read_tree(folder) == before, words


def name_case(case: Case) -> str:
    return " ".join(word[:24] for word in case[0]).encode("ascii", "backslashreplace").decode().replace("\n", "\\n") or "nothing"


@pytest.mark.parametrize("case", [*CALLS, *((["trace", *words], status) for words, status in TRACE)], ids=name_case)
@pytest.mark.verifies("SWR-CLI-046", technique="equivalence_classes", polarity="violation")
def test_bad_input_ends_in_one_line_and_changes_nothing(case: Case, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words, status = case
    before = read_tree(folder)

    found = main(words)

    shown = capsys.readouterr()
    check_refusal(words, status, (found, shown.out, shown.err), folder, before)


@pytest.mark.parametrize("case", LAUNCHER, ids=name_case)
@pytest.mark.verifies("SWR-CLI-046", technique="equivalence_classes", polarity="violation")
def test_bad_words_end_in_the_launcher_in_one_line(case: Case, folder: Path) -> None:
    words, status = case
    before = read_tree(folder)

    done = subprocess.run([str(ROOT / "mamori"), *words], capture_output=True, check=False, stdin=subprocess.DEVNULL)

    check_refusal(words, status, (done.returncode, done.stdout.decode(), os.fsdecode(done.stderr).encode("utf-8", "backslashreplace").decode()), folder, before)


@pytest.mark.verifies("SWR-CLI-046", technique="interface")
def test_the_table_has_each_command_and_each_action() -> None:
    assert set(list_commands()) <= {words[0] for words, _ in CALLS if words}
    assert set(re.findall(r"^  ([a-z]+) ", make_texts()["trace"], re.MULTILINE)) <= {words[0] for words, _ in TRACE if words}
    assert len(CALLS) + len(TRACE) + len(LAUNCHER) >= 100
