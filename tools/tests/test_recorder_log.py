# SPDX-License-Identifier: Apache-2.0
# Goal: `mamori log` shows and exports the content of a recorder file, and rejects an invalid file in one line. Method: the command in this
# process, on handwritten files; the library that viewers use reads the exported files.
from __future__ import annotations

import csv
import json
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from mcap.reader import make_reader
from recorder_files import make_crash, make_file, make_record, write

from mamori_tools.command.main import main
from mamori_tools.log.names import Names, read_names
from mamori_trace.base.errors import InputError

NAMES = {"sources": {"0": "supervisor"}, "codes": {"0": {"name": "state_entered", "argument": "state"}, "1": "fault_latched"},
         "arguments": {"state": {"0": "SelfTest", "2": "Operational"}}}  # fmt: skip
RECORDS = [
    make_record(1, code=0, argument=2, time_ns=1_500_000_000),
    make_record(2, code=1, severity=2, argument=-4, time_ns=1_500_000_001),
    make_record(3, session=2, code=9, severity=1, source=3, time_ns=-5),
]


@pytest.fixture
def recorder(tmp_path: Path) -> Path:
    return write(tmp_path / "run.rec", make_file(4, RECORDS, session=2))


@pytest.fixture
def names(tmp_path: Path) -> Path:
    return write(tmp_path / "names.json", json.dumps(NAMES).encode())


def log(*words: object) -> int:
    return main(["log", *map(str, words)])


@pytest.mark.verifies("SWR-REC-011")
def test_table_shows_each_record_with_its_names(recorder: Path, names: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert log(recorder, "--names", names) == 0

    said = capsys.readouterr()
    lines = [line.split() for line in said.out.splitlines()]
    assert lines[0] == ["sequence", "session", "time", "[s]", "severity", "source", "event", "argument"]
    assert lines[1] == ["1", "1", "1.500000000", "info", "supervisor", "state_entered", "Operational"]
    assert lines[2] == ["2", "1", "1.500000001", "fault", "supervisor", "fault_latched", "-4"]
    assert lines[3] == ["3", "2", "-0.000000005", "warning", "3", "9", "0"]
    assert "3 records, numbers 1 to 3; session 2; room for 4; 0 overwritten before; no damage" in said.out
    assert "\x1b" not in said.out
    assert said.err == ""


@pytest.mark.verifies("SWR-REC-011")
def test_names_beside_the_file_are_found(recorder: Path, names: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names.rename(recorder.with_name("run.rec.names.json"))

    assert log(recorder) == 0
    assert "supervisor" in capsys.readouterr().out


@pytest.mark.verifies("SWR-REC-011", technique="fault_injection", polarity="violation")
def test_broken_names_that_nobody_asked_for_do_not_hide_the_log(recorder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recorder.with_name("run.rec.names.json").write_text("{", encoding="utf-8")

    assert log(recorder) == 1
    said = capsys.readouterr()
    assert "numbers 1 to 3" in said.out
    assert "printed without names" in said.err


@pytest.mark.verifies("SWR-REC-011", technique="fault_injection", polarity="violation")
def test_damage_is_shown_where_it_belongs_and_told_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "run.rec", make_file(9, [make_record(1), make_record(2, commit=0), make_record(5), make_record(6)]))

    assert log(path) == 1

    said = capsys.readouterr()
    lines = said.out.splitlines()
    assert lines[2] == "  -- torn at offset 104: record 2, slot 1: the writer ended in mid-write"
    assert lines[3] == "  -- missing at offset 144: records 3 to 4 are missing"
    assert lines[4].split()[0] == "5"
    assert said.err.count("\n") == 1
    assert "1 torn, 1 missing, first at offset 104" in said.err
    assert "keep a copy" in said.err


@pytest.mark.verifies("SWR-REC-011")
@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("n.yaml", "sources: {0: supervisor}\ncodes:\n  0: {name: state_entered, argument: state}\narguments: {state: {2: Up}}\n"),
        ("n.toml", '[sources]\n0 = "supervisor"\n[codes.0]\nname = "state_entered"\nargument = "state"\n[arguments.state]\n2 = "Up"\n'),
        ("n.json", '{"sources": {"0": "supervisor"}, "codes": {"0": {"name": "state_entered", "argument": "state"}},'
                   ' "arguments": {"state": {"2": "Up"}}}'),
    ],
)  # fmt: skip
def test_name_tables_of_each_kind_say_the_same(tmp_path: Path, name: str, text: str) -> None:
    assert read_names(write(tmp_path / name, text.encode())) == Names(
        {0: "supervisor"}, {0: "state_entered"}, {0: "state"}, {"state": {2: "Up"}}
    )


@pytest.mark.verifies("SWR-REC-011", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        ("n.txt", "x", "a name table ends in .json"),
        ("n.json", "{", "is no json text"),
        ("n.json", "[" * 100_000, "is no json text"),
        ("n.yaml", "a: [", "is no yaml text"),
        ("n.toml", "a =", "is no toml text"),
        ("n.json", "[1]", "the table must be a table"),
        ("n.json", '{"sorces": {}}', "nearest: sources"),
        ("n.json", '{"sources": {"zero": "x"}}', "sources: 'zero' is not an integer"),
        ("n.yaml", "sources: {0: on}", "sources.0 must be a printable name"),
        ("n.json", '{"sources": {"0": "a\\u001b[2J"}}', "sources.0 must be a printable name"),
        ("n.json", '{"codes": {"0": {"name": "x", "argument": "stat"}}, "arguments": {"state": {}}}', "nearest: state"),
        ("n.json", '{"codes": {"0": {"argument": "state"}}, "arguments": {"state": {}}}', "codes.0 must be"),
    ],
)
def test_broken_name_table_is_answered_with_its_place(recorder: Path, name: str, text: str, sentence: str,
                                                      capsys: pytest.CaptureFixture[str]) -> None:  # fmt: skip
    path = write(recorder.with_name(name), text.encode())

    assert log(recorder, "--names", path) == 2
    said = capsys.readouterr()
    assert sentence in said.err
    assert said.err.count("\n") == 1
    assert said.out == ""


@pytest.mark.verifies("SWR-REC-012")
def test_mcap_is_read_back_with_the_library_of_the_viewers(recorder: Path, names: Path) -> None:
    out = recorder.with_name("run.mcap")
    assert log(recorder, "--names", names, "--mcap", out) == 0

    with out.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        rows = [(schema, channel, message) for schema, channel, message in reader.iter_messages(log_time_order=False)]
        metadata = {record.name: record.metadata for record in reader.iter_metadata()}
    assert [message.sequence for _, _, message in rows] == [1, 2, 3]
    assert [channel.topic for _, channel, _ in rows] == ["/events/session_1", "/events/session_1", "/events/session_2"]
    assert [message.log_time for _, _, message in rows] == [1_500_000_000, 1_500_000_001, 0]
    schema, channel, message = rows[1]
    assert schema is not None
    assert (schema.name, schema.encoding, channel.message_encoding) == ("foxglove.Log", "jsonschema", "json")
    body = json.loads(message.data)
    assert body == {"timestamp": {"sec": 1, "nsec": 500_000_001}, "level": 4, "message": "fault_latched -4", "name": "supervisor",
                    "file": "run.rec", "line": 0, "sequence": 2, "session": 1, "time_ns": 1_500_000_001, "severity": "fault",
                    "source": 0, "code": 1, "argument": -4}  # fmt: skip
    properties = json.loads(schema.data)["properties"]
    assert set(properties) == set(body)
    assert metadata["mamori.log"]["file"] == "run.rec"
    assert json.loads(metadata["mamori.log"]["findings"]) == []


@pytest.mark.verifies("SWR-REC-012")
def test_csv_and_json_hold_the_same_records(recorder: Path, names: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = recorder.with_name("run.csv")
    assert log(recorder, "--names", names, "--csv", out) == 0
    capsys.readouterr()
    assert log(recorder, "--names", names, "--json") == 0

    document = json.loads(capsys.readouterr().out)
    rows = list(csv.DictReader(out.read_text(encoding="utf-8").splitlines()))
    assert (document["schema"], document["capacity"], document["findings"]) == ("mamori.log/1", 4, [])
    for row, record in zip(rows, document["records"], strict=True):
        for key in set(row) - {"time_s"}:
            assert row[key] == str(record[key])
    assert rows[2]["time_s"] == "-0.000000005"
    assert document["records"][0]["argument_name"] == "Operational"


@pytest.mark.verifies("SWR-REC-012", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("option", ["--mcap", "--csv"])
def test_export_that_cannot_be_written_leaves_nothing_behind(recorder: Path, option: str,
                                                             capsys: pytest.CaptureFixture[str]) -> None:  # fmt: skip
    folder = recorder.with_name("folder")
    folder.mkdir()
    for out in (recorder.with_name("gone") / "out", folder):
        assert log(recorder, option, out) == 2
        said = capsys.readouterr().err
        assert "cannot be written" in said
        assert said.count("\n") == 1
    assert sorted(path.name for path in recorder.parent.iterdir()) == ["folder", "run.rec"]
    assert list(folder.iterdir()) == []


@pytest.mark.verifies("SWR-REC-012", technique="fault_injection", polarity="violation")
def test_export_keeps_an_older_file_when_it_fails(recorder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = write(recorder.with_name("run.mcap"), b"older")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("mcap.writer.Writer.add_message", fail)
    assert log(recorder, "--mcap", out) == 2
    assert out.read_bytes() == b"older"
    assert len(list(recorder.parent.iterdir())) == 2


@pytest.mark.verifies("SWR-REC-012", technique="error_guessing", polarity="violation")
@pytest.mark.parametrize("option", ["--mcap", "--csv"])
def test_recorder_file_is_never_its_own_export(recorder: Path, option: str, capsys: pytest.CaptureFixture[str]) -> None:
    before = recorder.read_bytes()
    link = recorder.with_name("link")
    link.symlink_to(recorder)

    for out in (recorder, link):
        assert log(recorder, option, out) == 2
        assert "would replace the input file" in capsys.readouterr().err
    assert recorder.read_bytes() == before


@pytest.mark.verifies("SWR-REC-013", technique="equivalence_classes", polarity="violation")
def test_what_is_no_recorder_file_is_answered_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(tmp_path / "pipe")
    empty = write(tmp_path / "empty", b"")
    foreign = write(tmp_path / "foreign", b"hello world " * 20)
    newer = write(tmp_path / "newer", make_file(2, [make_record(1)], version=7))
    for path, sentence in (
        (tmp_path, "is a directory"), (tmp_path / "gone", "not found"), (tmp_path / "pipe", "no regular file"),
        (empty, "is empty"), (foreign, "is no recorder file"), (newer, "format version 7"),
        (".", "is a directory"), ("/", "is a directory"), (tmp_path / ("a" * 300), "name too long; check path"),
    ):  # fmt: skip
        assert log(path, "--mcap", tmp_path / "out.mcap") == 2
        said = capsys.readouterr()
        assert sentence in said.err
        assert said.err.count("\n") == 1
        assert said.out == ""
    assert not (tmp_path / "out.mcap").exists()


@pytest.mark.verifies("SWR-REC-013", technique="equivalence_classes", polarity="violation")
def test_file_that_may_not_be_read_is_answered_in_one_line(recorder: Path, capsys: pytest.CaptureFixture[str],
                                                           monkeypatch: pytest.MonkeyPatch) -> None:  # fmt: skip
    recorder.chmod(0)
    if os.access(recorder, os.R_OK):  # root may read everything, so the system call is replaced by an error

        def refuse(*_: object) -> bytes:
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr(Path, "read_bytes", refuse)

    assert log(recorder) == 2
    assert "cannot be read: Permission denied" in capsys.readouterr().err
    recorder.chmod(stat.S_IRUSR | stat.S_IWUSR)


@pytest.mark.verifies("SWR-REC-013")
def test_cut_file_is_printed_and_exported_as_far_as_it_goes(recorder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recorder.write_bytes(recorder.read_bytes()[:150])
    out = recorder.with_name("run.mcap")

    assert log(recorder, "--mcap", out) == 1

    said = capsys.readouterr()
    assert "numbers 1 to 2" in said.out
    assert said.err.count("\n") == 1
    assert "the file ends here, at 150 of 224 bytes" in said.err
    with out.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None and summary.statistics is not None
    assert summary.statistics.message_count == 2


@pytest.mark.verifies("SWR-REC-011", technique="error_guessing", polarity="violation")
def test_reader_who_has_seen_enough_ends_it_without_a_complaint(tmp_path: Path) -> None:
    path = write(tmp_path / "run.rec", make_file(20_000, [make_record(number) for number in range(1, 20_001)]))
    command = f"'{sys.executable}' -P -m mamori_tools.command log '{path}' --csv '{tmp_path}/out.csv' | head -n 3"

    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False, timeout=120)

    assert done.stdout.count("\n") == 3
    assert done.stderr == ""
    assert (tmp_path / "out.csv").read_text(encoding="utf-8").count("\n") == 20_001


@pytest.mark.verifies("SWR-REC-013", technique="error_guessing", polarity="violation")
def test_input_error_is_one_line() -> None:
    assert str(InputError("a\nb", Path("c"))) == "c: a b"


@pytest.mark.verifies("SWR-PRT-028")
@pytest.mark.parametrize(
    ("note", "line"),
    [
        (make_crash(session=2, address=0x10, window=1, component=5, time_ns=1_250_000_000),
         "crash in session 2 at 1.250000000 s: SIGSEGV at address 0x10; window 1, component 5 of the system table"),
        (make_crash(number=6, is_sent=1, component=0xFFFE),
         "crash in session 1 at 0.000000000 s: SIGABRT, sent by a program; thread of the watchdog"),
        (make_crash(number=4, address=255), "crash in session 1 at 0.000000000 s: SIGILL at address 0xff; outside of all components"),
        (make_crash(window=3), "SIGSEGV at address 0x0; window 3, component unknown of the system table"),
    ],
)  # fmt: skip
def test_crash_is_told_in_a_line_and_in_each_export(tmp_path: Path, capsys: pytest.CaptureFixture[str], note: bytes, line: str) -> None:
    path = write(tmp_path / "run.rec", make_file(4, RECORDS, session=2) + note)

    assert log(path) == 0, "a crash is no damage of the file"
    said = capsys.readouterr()
    assert line in said.out
    assert said.err == ""
    assert log(path, "--json") == 0
    assert line in json.loads(capsys.readouterr().out)["crash"]["text"]
    assert log(path, "--mcap", tmp_path / "run.mcap") == 0
    with (tmp_path / "run.mcap").open("rb") as stream:
        metadata = {record.name: record.metadata for record in make_reader(stream).iter_metadata()}
    assert line in json.loads(metadata["mamori.log"]["crash"])["text"]


@pytest.mark.verifies("SWR-PRT-028", technique="fault_injection", polarity="violation")
def test_damaged_note_is_told_after_the_records(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / "run.rec", make_file(4, RECORDS, session=2) + make_crash()[:-1] + b"?")

    assert log(path) == 1
    said = capsys.readouterr()
    assert "-- corrupt at offset 224: note of a crash" in said.out
    assert "1 corrupt, first at offset 224" in said.err
