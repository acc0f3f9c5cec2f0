# SPDX-License-Identifier: Apache-2.0
# Goal: `mamori table --as rtmsafety` writes the eight tables of RTMSafety by the rules of docs/manual/rtmsafety.md, and names what they cannot
# express. Method: handwritten tables; rows are compared as lists of columns; two C compilers compile the files with declarations of this test.
from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from mamori_tools.command.main import main

US, MS = 1_000, 1_000_000
FILES = ("RtcCreateTbl.c", "DataPortCreateTbl.c", "DataPortConctTbl.c", "RtcEcCreateTbl.c", "EcAwakingTbl.c", "SafetyMntMngTbl.c", "SafetySndMngTbl.c",
         "FaultDiagnosisMngTbl.c")  # fmt: skip
SYSTEM_ROWS = [["1", "0", "1", "EC_INDEX_DATAPORT_CONCT_MNG"], ["1", "1", "1", "EC_INDEX_RTC_LIFE_CYCLE_MNT"],
               ["1", "2", "1", "EC_INDEX_RTC_LIFE_CYCLE_SND"], ["1", "3", "1", "EC_INDEX_RECEIVE_EC"]]  # fmt: skip
Row = dict[str, object]


def window(name: str, offset: int, period: int = 10 * MS, **more: object) -> Row:
    return {"name": name, "core": 0, "background_of": None, "partition": "", "kind": "periodic", "offset_ns": offset, "length_ns": 500 * US,
            "period_ns": period, "budget_ns": 400 * US, "rate_hz": None, "slower_periods_ns": [], "events_per_cycle": None, **more}  # fmt: skip


def component(name: str, index: int | None, **ports: int | None) -> Row:
    """@param ports size of each; inputs begin with "in"."""
    return {"name": name, "window": index, "worst_case_ns": None,
            "ports": [{"name": port, "direction": port[:2] if port.startswith("in") else "out", "mandatory": False, "payload_bytes": size}
                      for port, size in ports.items()]}  # fmt: skip


def connection(source: int, out: str, sink: int, into: str, **more: object) -> Row:
    return {"from": {"component": source, "port": out}, "to": {"component": sink, "port": into}, "way": "later_window", "fresh_within_ns": None,
            "only_in": None, "modes": [], **more}  # fmt: skip


def make_table(**changes: object) -> Row:
    return {
        "schema": "mamori.table/5", "frame_ns": 20 * MS, "abort_policy": "spec_only",
        "windows": [window("check", 6 * MS), window("drive", MS, 20 * MS), window("rtc_life_cycle_mnt", 8 * MS, kind="system")],
        "components": [component("wheel", 0, out=24, out_2=8), component("monitor", 0, **{"in": 24, "in-2": 8}), component("motor", 1, **{"in": 24}),
                       component("supervise", 2)],
        "connections": [connection(0, "out", 1, "in", way="same_window"), connection(0, "out_2", 1, "in-2", way="queue"),
                        connection(0, "out", 2, "in", fresh_within_ns=20 * MS)],
        "faults": [], "reactions": [], "safety": None, "modes": [], "transitions": [], "parameters": [], "configuration_sets": [], "findings": [], **changes,
    }  # fmt: skip


def export(folder: Path, table: Row) -> int:
    (folder / "table.json").write_text(json.dumps(table), encoding="utf-8")
    return main(["table", str(folder / "table.json"), "--as", "rtmsafety", "--out", str(folder / "out")])


def read_rows(folder: Path, name: str) -> list[list[str]]:
    text = (folder / "out" / name).read_text(encoding="utf-8")
    body = text[text.index("= {") + 3 : text.index("};")]
    return [row.split(", ") for row in re.findall(r"\{(.*)\}", body)] or [body.strip().split(", ")]


@pytest.mark.verifies("SWR-CIF-013")
def test_rows_follow_the_rules(tmp_path: Path) -> None:
    assert export(tmp_path, make_table()) == 0

    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == sorted((*FILES, "differences.txt"))
    none = ["0"] * 14
    assert read_rows(tmp_path, "RtcCreateTbl.c") == [
        ["WHEEL_create", "RTC_INDEX_WHEEL", "0", "DATAPORT_INDEX_WHEEL_OUT", "DATAPORT_INDEX_WHEEL_OUT_2", *none],
        ["MONITOR_create", "RTC_INDEX_MONITOR", "0", "DATAPORT_INDEX_MONITOR_IN", "DATAPORT_INDEX_MONITOR_IN_2", *none],
        ["MOTOR_create", "RTC_INDEX_MOTOR", "0", "DATAPORT_INDEX_MOTOR_IN", "0", *none]]  # fmt: skip
    ports = ("WHEEL_OUT", "WHEEL_OUT_2", "MONITOR_IN", "MONITOR_IN_2", "MOTOR_IN")
    assert read_rows(tmp_path, "DataPortCreateTbl.c") == [[f"DATAPORT_INDEX_{name}"] for name in ports]
    assert read_rows(tmp_path, "DataPortConctTbl.c") == [
        ["OBJECTKEY_MONITOR_IN", "OBJECTKEY_WHEEL_OUT", "24", "0"], ["OBJECTKEY_MONITOR_IN_2", "OBJECTKEY_WHEEL_OUT_2", "8", "0"],
        ["OBJECTKEY_MOTOR_IN", "OBJECTKEY_WHEEL_OUT", "24", "0"]]  # fmt: skip
    assert read_rows(tmp_path, "RtcEcCreateTbl.c") == [
        ["EC_INDEX_DRIVE", "0", "0", "RTC_INDEX_MOTOR", "0", *none], ["EC_INDEX_CHECK", "0", "0", "RTC_INDEX_WHEEL", "RTC_INDEX_MONITOR", *none]]  # fmt: skip
    assert read_rows(tmp_path, "EcAwakingTbl.c") == [*SYSTEM_ROWS, ["2", "5", "5", "EC_INDEX_DRIVE"], ["1", "6", "5", "EC_INDEX_CHECK"]]
    assert read_rows(tmp_path, "SafetyMntMngTbl.c") == [["OBJECTKEY_WHEEL"], ["OBJECTKEY_MONITOR"], ["OBJECTKEY_MOTOR"]]
    assert read_rows(tmp_path, "SafetySndMngTbl.c") == [["OBJECTKEY_EMPTY", "OBJECTKEY_RTC_LIFE_CYCLE_MNT", *["OBJECTKEY_EMPTY"] * 9]]
    assert read_rows(tmp_path, "FaultDiagnosisMngTbl.c") == [["0", "0"]]


@pytest.mark.verifies("SWR-CIF-013")
def test_each_difference_and_each_constant_is_listed(tmp_path: Path) -> None:
    faults = [{"number": 0, "name": "Hot"}]
    windows = [window("check", 6 * MS, partition="open", slower_periods_ns=[20 * MS, 40 * MS]), window("drive", MS, 20 * MS),
               window("rtc_life_cycle_mnt", 8 * MS, kind="system")]  # fmt: skip
    table = make_table(faults=faults, windows=windows)
    table["components"][0]["worst_case_ns"] = 2 * MS  # type: ignore[index]
    table["components"][1]["ports"][0]["mandatory"] = True  # type: ignore[index]
    assert export(tmp_path, table) == 0

    lines = (tmp_path / "out" / "differences.txt").read_text(encoding="utf-8").splitlines()
    for line in (
        "* DataPortConctTbl.c, OBJECTKEY_MONITOR_IN: length 24; the template has always 12",
        "* EcAwakingTbl.c, EC_INDEX_DRIVE: multiple 2; the template has always 1",
        "* RtcEcCreateTbl.c, EC_INDEX_CHECK: components wheel, monitor; the template has a context per component",
        "* EC_INDEX_RTC_LIFE_CYCLE_MNT: system window 'rtc_life_cycle_mnt'", "* EC_INDEX_RECEIVE_EC: no system window; the row of the template",
        "* no column: OBJECTKEY_MONITOR_IN_2 is a queue; whether RTMSafety keeps each value is not known",
        "* no column: age limit 20 ms of OBJECTKEY_MOTOR_IN",
        "* no column: MajorTimeWindow of 10 ms; offset, length and budget of each window; abort policy 'spec_only'",
        "* no column: slower periods 20 ms, 40 ms of window 'check'", "* no column: worst case 2 ms of component 'wheel'",
        "* no column: OBJECTKEY_MONITOR_IN is mandatory",
        "* no column: partition 'open' of window 'check'", "* no column: faults with their reactions, parameters with their sets",
        "RTC_NUM 3", "DATAPORT_NUM 5", "DATAPORT_CONNECT_NUM 3", "RTCEC_NUM 2", "EC_AWAKE_SET_NUM 6", "RTC_MNT_NUM 3", "RTC_SND_NUM 10", "RTC_SELF_DIAGNOS 1",
        "OBJECTKEY_EMPTY 0", "RTC_INDEX_WHEEL 1", "EC_INDEX_DRIVE 5",
    ):  # fmt: skip
        assert line in lines
    assert not [line for line in lines if "RtcEcCreateTbl.c, EC_INDEX_DRIVE" in line]
    assert sum("is mandatory" in line for line in lines) == sum("worst case" in line for line in lines) == 1


@pytest.mark.verifies("SWR-CIF-013", technique="equivalence_classes")
def test_a_system_window_with_another_name_is_a_context_of_its_own(tmp_path: Path) -> None:
    windows = [window("notice", 0, kind="system"), *(window(name.lower(), MS, kind="system") for name in ("RECEIVE_EC", "DATAPORT_CONCT_MNG"))]
    assert export(tmp_path, make_table(windows=windows, components=[component("send", 0), component("a", 1), component("b", 2)], connections=[])) == 0

    assert read_rows(tmp_path, "EcAwakingTbl.c") == [*SYSTEM_ROWS, ["1", "5", "5", "EC_INDEX_NOTICE"]]
    assert [row[0] for row in read_rows(tmp_path, "RtcCreateTbl.c")] == ["SEND_create"]


@pytest.mark.verifies("SWR-CIF-013", technique="boundary_values")
def test_component_without_ports_and_connections_of_12_bytes_are_exported(tmp_path: Path) -> None:
    assert export(tmp_path, make_table(windows=[window("check", 0)], components=[component("clock", 0)], connections=[])) == 0
    assert read_rows(tmp_path, "DataPortCreateTbl.c") == [["0"]]
    assert read_rows(tmp_path, "DataPortConctTbl.c") == [["OBJECTKEY_EMPTY", "OBJECTKEY_EMPTY", "0", "0"]]
    differences = (tmp_path / "out" / "differences.txt").read_text(encoding="utf-8")
    assert "* a table without rows has one empty row" in differences and "length 0" not in differences

    parts = [component("wheel", 0, out=12), component("motor", 0, **{"in": 12})]
    assert export(tmp_path, make_table(windows=[window("check", 0)], components=parts, connections=[connection(0, "out", 1, "in")])) == 0
    assert "the template has always 12" not in (tmp_path / "out" / "differences.txt").read_text(encoding="utf-8")


DECLARATIONS = {
    "RtObject.h": "typedef int ReturnCode_t; typedef struct { int x; } RtObject_t;"
                  " typedef struct { ReturnCode_t (*create)(RtObject_t*); int index, reserve, ports[16]; } RtcCreate_t;",
    "DataPort.h": "typedef struct { int index; } DataPortCreate_t;",
    "DataPortConctMng.h": "typedef struct { int in, out, length, reserve; } DataPortConctSetting_t;",
    "RtcEc.h": "typedef struct { int index, reserve, task, components[16]; } RtcEcCreate_t;",
    "EcAwaking.h": "typedef struct { int multiple, minor, share, index; } EcAwakingSetting_t;",
    "SafetyMntMng.h": "typedef struct { int key; } SafetyMntSetting_t;",
    "SafetySndMng.h": "typedef struct { int bridge, addressees[RTC_SND_NUM]; } SafetySndSetting_t;",
    "SelfDiagnostic.h": "typedef struct { int (*check)(void); void (*handle)(void); } FaultDiagnosisMng_t;",
    "UserCommon.h": "", "SystemTbls.h": "", "MyObjectKey.h": "",
}  # fmt: skip
"""Declarations that the tables need. The headers of RTMSafety are not public."""


@pytest.mark.parametrize("compiler", ["gcc", "clang-19"])
@pytest.mark.verifies("SWR-CIF-013", technique="interface")
def test_tables_compile_as_c99(compiler: str, tmp_path: Path) -> None:
    assert shutil.which(compiler) is not None
    assert export(tmp_path, make_table()) == 0
    out = tmp_path / "out"
    constants = (out / "differences.txt").read_text(encoding="utf-8").partition("Constants ")[2].splitlines()[1:]
    own = {f"{name}.h": f'#include "RtObject.h"\nReturnCode_t {name}_create(RtObject_t*);' for name in ("WHEEL", "MONITOR", "MOTOR")}
    for name, text in {**DECLARATIONS, **own, "UserConfig.h": "".join(f"#define {line}\n" for line in constants)}.items():
        guard = name.replace(".", "_")
        (out / name).write_text(f"#ifndef {guard}\n#define {guard}\n{text}\n#endif\n", encoding="utf-8")

    done = subprocess.run([compiler, "-std=c99", "-pedantic", "-Werror", "-fsyntax-only", *FILES], cwd=out, capture_output=True, text=True, check=False)

    assert (done.returncode, done.stderr) == (0, "")


def many(count: int) -> dict[str, int | None]:
    return {f"in{number}": 4 for number in range(count)}


@pytest.mark.verifies("SWR-CIF-014", technique="boundary_values")
def test_limits_are_allowed(tmp_path: Path) -> None:
    parts = [component(f"c{number}", 0, **many(16)) for number in range(16)] + [component(f"s{number}", 1, **many(17)) for number in range(17)]
    windows = [window("check", 9500 * US), window("receive_ec", 0, kind="system")]
    assert export(tmp_path, make_table(windows=windows, components=parts, connections=[])) == 0
    assert len(read_rows(tmp_path, "RtcEcCreateTbl.c")[0]) == 19
    assert "0" not in read_rows(tmp_path, "RtcEcCreateTbl.c")[0][3:]


REFUSED: dict[str, tuple[Row, str]] = {
    "17 ports": ({"components": [component("wheel", 0, **many(17))], "connections": []},
                 "component 'wheel' has 17 ports; a component of RTMSafety has at most 16"),
    "17 components": ({"components": [component(f"c{number}", 0) for number in range(17)], "connections": []},
                      "window 'check' has 17 components; a context of RTMSafety has at most 16"),
    "no component": ({"components": [], "connections": [], "windows": []}, "has no component outside the built-in contexts"),
    "only built-in contexts": ({"components": [component("supervise", 2)], "connections": []}, "has no component outside the built-in contexts"),
    "no window": ({"components": [component("wheel", None)], "connections": [], "windows": []}, "component 'wheel' runs in no window"),
    "port of a built-in context": ({"connections": [connection(0, "out", 3, "in")]},
                                   "component 'supervise' runs in the built-in context 'rtc_life_cycle_mnt', which has no ports"),
    "finding": ({"findings": ["window 'a': too long"]}, "violates a rule, first of 1: window 'a': too long"),
    "mode": ({"modes": [{"name": "idle", "initial": True, "safe": True, "components": [], "set": None}]}, "has modes, and RTMSafety has none"),
    "core": ({"windows": [window("check", 0), window("drive", MS, core=1), window("late", 2 * MS)]}, "has windows on core 0, core 1"),
    "kind": ({"windows": [window("check", 0, kind="event_driven", events_per_cycle=1), window("drive", MS), window("late", 2 * MS)]},
             "window 'check' is event_driven"),
    "phase": ({"windows": [window("check", 10 * MS, 20 * MS), window("drive", MS, 10 * MS), window("late", 2 * MS)]},
              "window 'check' ends 10.5 ms after the start of the frame"),
    "end": ({"windows": [window("check", 9500 * US + 1, 20 * MS), window("drive", MS, 10 * MS), window("late", 2 * MS)]},
            "after the first MajorTimeWindow (10 ms); move or shorten it"),
    "slow system window": ({"windows": [window("check", 0), window("drive", MS), window("receive_ec", 2 * MS, 20 * MS, kind="system")]},
                           "system window 'receive_ec' has the period 20 ms"),
    "long value": ({"components": [component("wheel", 0, out=None, out_2=8), *make_table()["components"][1:]]},  # type: ignore[index]
                   "port 'out' of component 'wheel': the table has no length"),
    "unknown port": ({"connections": [connection(0, "out", 1, "input")]}, "a connection has the port 'input', which is a port of no component"),
    "no component of a connection": ({"connections": [connection(0, "out", 1, "in", **{"from": {"component": None, "port": "out"}})]},
                                     "a connection has the port 'out'"),
    "equal names": ({"components": [component("a b", 0), component("a-b", 0)], "connections": []},
                    "component 'a-b' and component 'a b' have the same name 'RTC_INDEX_A_B' in C; rename one"),
    "equal keys": ({"components": [component("a", 0, in_b=1), component("a_in_b", 0)], "connections": []}, "have the same name 'OBJECTKEY_A_IN_B'"),
    "reserved key": ({"components": [component("empty", 0)], "connections": []}, "component 'empty': 'OBJECTKEY_EMPTY' is a reserved name; rename it"),
    "reserved context": ({"windows": [window("check", 0), window("receive_ec", MS), window("late", 2 * MS)]}, "'EC_INDEX_RECEIVE_EC' is a reserved name"),
    "digit": ({"components": [component("2nd", 0)], "connections": []}, "component '2nd' does not begin with a letter"),
}  # fmt: skip


@pytest.mark.parametrize("case", REFUSED)
@pytest.mark.verifies("SWR-CIF-014", technique="boundary_values", polarity="violation")
def test_what_rtmsafety_cannot_express_is_named_and_nothing_is_written(case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    changes, message = REFUSED[case]

    assert export(tmp_path, make_table(**changes)) == 2

    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.verifies("SWR-CIF-014", technique="error_guessing", polarity="violation")
def test_the_folder_must_be_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "table.json").write_text(json.dumps(make_table()), encoding="utf-8")

    assert main(["table", str(tmp_path / "table.json"), "--as", "rtmsafety"]) == 2
    assert "--as needs --out DIR" in capsys.readouterr().err


@pytest.mark.parametrize("words", [("--out", "."), ("--out", "link"), ("--out", "out", "--svg-modes", "out/RtcCreateTbl.c")])
@pytest.mark.verifies("SWR-CIF-014", technique="error_guessing", polarity="violation")
def test_tables_never_share_a_file(words: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    text = json.dumps(make_table())
    (tmp_path / "differences.txt").write_text(text, encoding="utf-8")
    (tmp_path / "link").symlink_to(tmp_path)
    monkeypatch.chdir(tmp_path)

    assert main(["table", "differences.txt", "--as", "rtmsafety", *words]) == 2

    assert "is named twice" in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["differences.txt", "link"]
    assert (tmp_path / "differences.txt").read_text(encoding="utf-8") == text


@pytest.mark.verifies("SWR-CIF-014", technique="fault_injection", polarity="violation")
def test_a_file_that_cannot_be_written_leaves_all_others_unchanged(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "out" / "EcAwakingTbl.c").mkdir(parents=True)
    (tmp_path / "out" / "RtcCreateTbl.c").write_text("old", encoding="utf-8")

    assert export(tmp_path, make_table()) == 2

    error = capsys.readouterr().err
    assert "EcAwakingTbl.c: cannot be written: is a folder or a device" in error and error.count("\n") == 1
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["EcAwakingTbl.c", "RtcCreateTbl.c"]
    assert (tmp_path / "out" / "RtcCreateTbl.c").read_text(encoding="utf-8") == "old"
