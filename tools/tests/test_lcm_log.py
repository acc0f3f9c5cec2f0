# SPDX-License-Identifier: Apache-2.0
# Goal: `mamori log` shows an LCM log and exports each message as MCAP with equal content, and reports damage with its offset. Method: the
# command in this process; the code of lcm-gen encodes the messages, and the library that viewers use reads the exported files.
from __future__ import annotations

import importlib
import json
import math
import random
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from lcm_logs import BEGIN_US, make_event, write_types
from mcap.reader import make_reader

from mamori_tools.command.main import main
from mamori_tools.lcm.decoder import DecodeError, decode, find_type
from mamori_tools.lcm.log_file import Damage, Event, open_log
from mamori_tools.lcm.type_files import Types, read_types
from mamori_trace.base.errors import InputError

needs_lcm_gen = pytest.mark.skipif(shutil.which("lcm-gen") is None, reason="lcm-gen is not installed")
KEYS = ["i8", "i16", "i32", "i64", "e2e", "single", "big", "flag", "flags", "n", "m", "inner", "matrix", "words", "own"]


@pytest.fixture
def types(tmp_path: Path) -> Path:
    return write_types(tmp_path / "types")


@pytest.fixture
def official(types: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """The package `a` that lcm-gen makes."""
    files = [str(path) for path in sorted(types.iterdir())]
    subprocess.run(["lcm-gen", "--python", "--ppath", str(tmp_path / "python"), *files], check=True, capture_output=True)
    monkeypatch.syspath_prepend(str(tmp_path / "python"))
    yield importlib.import_module("a")
    for name in [name for name in sys.modules if name == "a" or name.startswith("a.")]:
        del sys.modules[name]


def make_official(official: Any, seed: int) -> Any:
    draw = random.Random(seed)
    inner_type = importlib.import_module("a.b").Inner
    value = official.Outer()
    value.i8, value.i16, value.i32, value.i64 = -128, 32767, draw.randint(-(2**31), 2**31 - 1), draw.randint(-(2**63), 2**63 - 1)
    value.e2e = bytes(draw.randrange(256) for _ in range(3))
    value.single, value.big = 0.5, draw.choice((math.nan, math.inf, -math.inf, draw.random()))
    value.flag, value.flags = draw.random() < 0.5, [True, False]
    value.n, value.m = draw.randrange(4), draw.randrange(3)
    value.inner = []
    for _ in range(value.n):
        inner = inner_type()
        inner.x, inner.name = [draw.random(), -0.0], "ä" * draw.randrange(3)
        value.inner.append(inner)
    value.matrix = [[[float(draw.randrange(9)), 0.25] for _ in range(value.m)] for _ in range(value.n)]
    value.words = ["word"] * value.m
    value.own.k = draw.randrange(128)
    return value


def make_plain(value: Any) -> Any:
    """A value of the code of lcm-gen, as JSON shows it."""
    if isinstance(value, float) and not math.isfinite(value):
        return "NaN" if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"
    if isinstance(value, bytes):
        return list(value)
    if isinstance(value, (list, tuple)):
        return [make_plain(one) for one in value]
    return {name: make_plain(getattr(value, name)) for name in value.__slots__} if hasattr(value, "__slots__") else value


def read_mcap(path: Path) -> list[tuple[str, str, str, int, int, bytes]]:
    """Topic, message encoding, schema, log time [ns], sequence and data of each message."""
    with path.open("rb") as stream:
        return [(channel.topic, channel.message_encoding, "" if schema is None else schema.name, message.log_time, message.sequence, message.data)
                for schema, channel, message in make_reader(stream).iter_messages()]  # fmt: skip


def log(*words: object) -> int:
    return main(["log", *map(str, words)])


@needs_lcm_gen
@pytest.mark.verifies("SWR-REC-017", technique="back_to_back")
def test_mcap_contains_each_message_with_the_values_that_were_encoded(tmp_path: Path, types: Path, official: Any,
                                                                      capsys: pytest.CaptureFixture[str]) -> None:  # fmt: skip
    values = [make_official(official, seed) for seed in range(200)]
    own = official.Own()
    own.k = 7
    events = [make_event(i, 10 * i, "OUTER", value.encode()) for i, value in enumerate(values)] + [make_event(200, 5000, "OWN", own.encode())]
    path, out = tmp_path / "run.lcmlog", tmp_path / "run.mcap"
    path.write_bytes(b"".join(events))

    assert log(path, "--types", types, "--mcap", out) == 0

    said = capsys.readouterr()
    octets = sum(len(value.encode()) for value in values)
    assert [line.split() for line in said.out.splitlines()] == [
        ["channel", "type", "events", "octets", "first", "[s]", "last", "[s]"],
        ["OUTER", "a.Outer", "200", str(octets), "0.000000000", "0.001990000"], ["OWN", "a.Own", "1", "9", "0.005000000", "0.005000000"],
        ["201", "events;", "0", "damaged", "parts"]]  # fmt: skip
    assert said.err == ""
    found = read_mcap(out)
    assert len(found) == 201
    for i, (value, one) in enumerate(zip(values, found, strict=False)):
        assert one[:5] == ("OUTER", "json", "a.Outer", (BEGIN_US + 10 * i) * 1000, i)
        assert json.loads(one[5]) == make_plain(value)
        assert list(json.loads(one[5])) == KEYS
    assert found[200][:3] == ("OWN", "json", "a.Own") and json.loads(found[200][5]) == {"k": 7}
    with out.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    schemas = {schema.name: json.loads(schema.data) for schema in summary.schemas.values()}
    assert list(schemas["a.Outer"]["properties"]) == KEYS
    assert schemas["a.Outer"]["properties"]["matrix"]["items"]["items"]["items"]["type"] == ["number", "string"]


@needs_lcm_gen
@pytest.mark.verifies("SWR-REC-017", technique="fault_injection", polarity="violation")
def test_truncated_longer_and_invalid_messages_are_rejected(types: Path, official: Any) -> None:
    known = read_types(types)
    data = make_official(official, 4).encode()
    kind = find_type(known, data)
    assert kind is not None

    for size in range(8, len(data)):
        with pytest.raises(DecodeError):
            decode(known, kind, data[:size])
    with pytest.raises(DecodeError, match="1 octets longer"):
        decode(known, kind, data + b"x")
    draw = random.Random(1)
    for _ in range(2000):  # any other content is decoded or rejected
        changed = bytearray(data)
        changed[draw.randrange(8, len(data))] = draw.randrange(256)
        try:
            decode(known, kind, bytes(changed))
        except DecodeError:
            continue


OWN_DATA = (0x0).to_bytes(8, "big") + b"\x07"


def make_own(types: Types, k: int) -> bytes:
    [fingerprint] = [value for value, kind in types.fingerprints.items() if kind.name == "a.Own"]
    return fingerprint.to_bytes(8, "big") + bytes([k])


@pytest.mark.verifies("SWR-REC-017", technique="equivalence_classes", polarity="violation")
def test_unknown_types_are_written_as_they_are_and_counted(tmp_path: Path, types: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = tmp_path / "run.lcmlog", tmp_path / "run.mcap"
    own = make_own(read_types(types), 5)
    messages = [("OWN", own), ("OTHER", OWN_DATA), ("OTHER", OWN_DATA), ("SHORT", b"ab")]
    path.write_bytes(b"".join(make_event(i, i, channel, data) for i, (channel, data) in enumerate(messages)))

    assert log(path, "--types", types, "--mcap", out) == 0

    said = capsys.readouterr().err.splitlines()
    assert said == ["mamori: 'OTHER': 2 messages of unknown type (fingerprint 0000000000000000) written without decoding; add its .lcm file",
                    "mamori: 'SHORT': 1 messages of unknown type (fingerprint 6162) written without decoding; add its .lcm file"]  # fmt: skip
    assert [(topic, encoding, schema, data) for topic, encoding, schema, _, _, data in read_mcap(out)] == [
        ("OWN", "json", "a.Own", b'{"k": 5}'), ("OTHER", "x-lcm", "", OWN_DATA), ("OTHER", "x-lcm", "", OWN_DATA), ("SHORT", "x-lcm", "", b"ab")]  # fmt: skip


@pytest.mark.verifies("SWR-REC-017", technique="fault_injection", polarity="violation")
def test_message_that_does_not_match_its_type_is_a_finding(tmp_path: Path, types: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, out = tmp_path / "run.lcmlog", tmp_path / "run.mcap"
    own = make_own(read_types(types), 5)
    path.write_bytes(make_event(0, 0, "OWN", own) + make_event(1, 1, "OWN", own + b"x"))

    assert log(path, "--types", types, "--mcap", out) == 1

    assert "1 invalid messages, first at offset 40: message on 'OWN' is no a.Own: the message is 1 octets longer" in capsys.readouterr().err
    assert [(encoding, data) for _, encoding, _, _, _, data in read_mcap(out)] == [("json", b'{"k": 5}'), ("x-lcm", own + b"x")]


@pytest.mark.verifies("SWR-REC-016", technique="fault_injection", polarity="violation")
def test_log_that_is_cut_anywhere_keeps_the_events_before_the_cut(tmp_path: Path, types: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first, second = make_event(0, 0, "ONE", b"12345678"), make_event(1, 5, "TWO", b"12345678")
    path = tmp_path / "run.lcmlog"
    for size in range(len(first) + 1, len(first) + len(second)):
        path.write_bytes((first + second)[:size])
        with open_log(path) as opened:
            event, damage = opened.read()
        assert isinstance(event, Event) and (event.channel, event.data, event.time_us) == ("ONE", b"12345678", BEGIN_US)
        assert isinstance(damage, Damage) and (damage.offset, damage.size) == (len(first), size - len(first))

    assert log(path, "--types", types, "--mcap", tmp_path / "out.mcap") == 1
    said = capsys.readouterr()
    assert f"-- damaged at offset {len(first)}: {len(second) - 1} bytes, the log ends within an event" in said.out
    assert f"1 damaged parts, first at offset {len(first)}" in said.err
    assert len(read_mcap(tmp_path / "out.mcap")) == 1


@pytest.mark.verifies("SWR-REC-016", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(("position", "byte"), [(0, 0), (20, 1), (23, 4), (23, 2), (23, 0), (24, 127), (27, 9), (27, 7), (28, 200)])
def test_reading_continues_after_a_damaged_event(tmp_path: Path, position: int, byte: int) -> None:
    events = [make_event(i, i, f"C{i}x", bytes(8)) for i in range(3)]
    damaged = bytearray(events[1])
    damaged[position] = byte
    path = tmp_path / "run.lcmlog"
    path.write_bytes(events[0] + bytes(damaged) + events[2])

    with open_log(path) as opened:
        found = list(opened.read())

    assert [type(one) for one in found] == [Event, Damage, Event]
    assert (found[1].offset, found[2].offset) == (len(events[0]), 2 * len(events[0]))


@pytest.mark.verifies("SWR-REC-016", technique="boundary_values")
def test_channel_names_have_1_to_63_characters(tmp_path: Path) -> None:
    path = tmp_path / "run.lcmlog"
    for size, kind in ((1, Event), (63, Event), (64, Damage), (0, Damage)):
        path.write_bytes(make_event(0, 0, "a" * size, b""))
        with open_log(path) as opened:
            assert [type(one) for one in opened.read()] == [kind]


@pytest.mark.verifies("SWR-REC-016")
def test_log_without_types_shows_fingerprints(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "run.lcmlog"
    path.write_bytes(make_event(0, 0, "ONE", OWN_DATA))

    assert log(path) == 0

    assert "fingerprint 0000000000000000       1" in capsys.readouterr().out


@pytest.mark.verifies("SWR-REC-016", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(("words", "said"), [
    (("--mcap", "OUT"), "--mcap of an LCM log needs --types DIR"), (("--csv", "OUT"), "--csv is for the file of a flight recorder"),
    (("--json",), "--json is for the file of a flight recorder"), (("--names", "x"), "--names is for the file of a flight recorder"),
    (("--types", "none", "--mcap", "OUT"), "not a folder"), (("--types", ".", "--mcap", "OUT"), "contains no .lcm file with a struct"),
    (("--types", "types", "--mcap", "run.lcmlog"), "would replace the input file"),
    (("--types", "types", "--mcap", "/dev/full"), "is a folder or a device"), (("--types", "types", "--mcap", "no/OUT"), "cannot be written"),
])  # fmt: skip
def test_wrong_options_are_rejected_in_one_line(tmp_path: Path, types: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch,
                                                words: tuple[str, ...], said: str) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    before = make_event(0, 0, "ONE", OWN_DATA)
    Path("run.lcmlog").write_bytes(before)

    assert log("run.lcmlog", *words) == 2

    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 1 and said in errors[0]
    assert Path("run.lcmlog").read_bytes() == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.lcmlog", types.name]


@pytest.mark.verifies("SWR-REC-016", technique="equivalence_classes", polarity="violation")
def test_log_without_intact_event_and_types_for_a_recorder_are_rejected(tmp_path: Path, types: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "run.lcmlog"
    path.write_bytes(make_event(0, 0, "ONE", OWN_DATA)[:-1])
    assert log(path) == 2
    assert "contains no intact event" in capsys.readouterr().err
    path.write_bytes(b"hello")
    assert log(path, "--types", types) == 2
    assert "--types is for LCM logs" in capsys.readouterr().err


@pytest.mark.verifies("SWR-REC-017", technique="fault_injection", polarity="violation")
def test_full_disk_leaves_the_older_file(tmp_path: Path, types: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    path, out = tmp_path / "run.lcmlog", tmp_path / "run.mcap"
    path.write_bytes(make_event(0, 0, "ONE", OWN_DATA))
    out.write_bytes(b"older")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("mcap.writer.Writer.add_message", fail)
    assert log(path, "--types", types, "--mcap", out) == 2

    assert "No space left on device" in capsys.readouterr().err
    assert out.read_bytes() == b"older"
    assert len(list(tmp_path.iterdir())) == 3


@pytest.mark.verifies("SWR-REC-017", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(("text", "said"), [
    ("struct S {", "the file ends within a declaration"), ("struct S { int32_t; }", "';' is not a name"), ("enum E { A }", "'enum' is not supported"),
    ("struct S { Other x; }", "no type 'Other' in this folder"), ("struct S { S x; }", "contains itself"),
    ("struct S { int32_t a; int32_t a; }", "two members 'a'"), ("struct S { double d[n]; }", "array size 'n' is neither"),
    ("struct S { double n; double d[n]; }", "array size 'n' is neither"), ("struct S { double d[0]; }", "array size 0"),
    ("struct S { int32_t a }", "'}' instead of ';'"), ("struct S { int32_t a; } ?", "unexpected character '?'"),
    ("package ;", "';' is not a name"), ("package a.b;\nstruct Inner { int8_t k; }", "struct a.b.Inner is also in inner.lcm"), ("\x00", "binary file"),
])  # fmt: skip
def test_invalid_type_files_are_rejected_with_their_place(types: Path, text: str, said: str) -> None:
    (types / "x.lcm").write_text(text, encoding="utf-8")

    with pytest.raises(InputError, match=r"x\.lcm") as caught:
        read_types(types)
    assert said in str(caught.value)
