# SPDX-License-Identifier: Apache-2.0
# Goal: rtc.conf is read as OpenRTM reads it, and no byte changes except in the changed entry.
from __future__ import annotations

from pathlib import Path

import pytest
from profile_samples import CONF

from mamori_tools.profiles.conf_file import ConfFile
from mamori_tools.profiles.profile import load_profile
from mamori_trace.base.errors import InputError


@pytest.mark.verifies("SWR-PFL-007")
def test_keys_have_the_values_of_all_their_lines() -> None:
    conf = ConfFile(CONF)

    assert [(entry.key, entry.value, entry.first, entry.last) for entry in conf.entries] == [
        ("corba.nameservers", "localhost", 2, 2), ("manager.modules.load_path", "./, ../lib", 3, 4),
        ("manager.components.preconnect", "a.out?port=b.in, b.out?port=c.in", 7, 9), ("example.Motor.conf.default.gain", "1.0", 10, 10),
        ("manager.components.precreate", "", 11, 11), ("logger.enable", "NO", 12, 12)]  # fmt: skip
    assert conf.deviations == []


@pytest.mark.verifies("SWR-PFL-007")
@pytest.mark.parametrize("data", [CONF, CONF.replace(b"\r", b""), b"\xff# euc\na: 1\n", b"", b"a: 1", b"a:\x0b1\x0c\n\n\n", "# モータ\nキー: 値\n".encode()])
def test_bytes_come_back_unchanged(data: bytes) -> None:
    assert ConfFile(data).format() == data


@pytest.mark.verifies("SWR-PFL-007")
@pytest.mark.parametrize(("line", "key", "value"), [
    ("a: b", "a", "b"), ("a:b:c", "a", "b:c"), ("a=b", "a", "b"), ("  a  :  b  ", "a", "b"),
    ("a.b.c : ", "a.b.c", ""), (r"a\:b: c", "a:b", "c"), ("a: b\\\\", "a", "b\\"),
    (r"a: C:\\x\ty\q", "a", "C:\\x\tyq"), ("a b c", "a", "b c"), (r"a\ b c", "a b", "c"), ("a", "a", ""),
])  # fmt: skip
def test_spellings_of_an_entry(line: str, key: str, value: str) -> None:
    conf = ConfFile(line.encode() + b"\n")

    assert [(entry.key, entry.value) for entry in conf.entries] == [(key, value)]


@pytest.mark.verifies("SWR-PFL-007")
@pytest.mark.parametrize(("key", "old", "new"), [
    ("corba.nameservers", b"corba.nameservers: localhost\r\n", b"corba.nameservers: x y\r\n"),
    ("manager.modules.load_path", b"load_path: ./, \\\r\n\t\t../lib\r\n", b"load_path: x y\r\n"),
    ("example.Motor.conf.default.gain", b"gain=1.0", b"gain=x y"),
    ("logger.enable", b"logger.enable: NO", b"logger.enable: x y"),
    ("new.key", b"logger.enable: NO", b"logger.enable: NO\r\nnew.key: x y\r\n"),
])  # fmt: skip
def test_a_changed_value_changes_only_its_entry(key: str, old: bytes, new: bytes) -> None:
    conf = ConfFile(CONF)
    conf.set_value(key, "x y")

    assert conf.format() == CONF.replace(old, new)
    assert conf.get_value(key) == "x y"
    assert conf.get_value("other") is None


@pytest.mark.verifies("SWR-PFL-007", technique="error_guessing")
@pytest.mark.parametrize("data", [CONF, b"", b"x \\\n1\n"])
@pytest.mark.parametrize(("key", "value"), [("x", "y\\"), ("x", "a\nb\r\tc"), ("#k", "1"), ("k:e", "1"), ("a b", "#c"), ("!", ""), ("x", "y: z")])
def test_any_text_that_is_set_is_read_back(data: bytes, key: str, value: str) -> None:
    conf = ConfFile(data)
    conf.set_value(key, value)
    conf.set_value(key, value)

    assert ConfFile(conf.format()).get_value(key) == value
    assert len(ConfFile(conf.format()).entries) == len(ConfFile(data).entries) + (ConfFile(data).get_value(key) is None)


@pytest.mark.verifies("SWR-PFL-007", polarity="violation")
@pytest.mark.parametrize(("data", "key", "value"), [(CONF, "", "1"), (CONF, "x", " y"), (CONF, " x", "y"), (b"a: 1, \\", "x", "y")])
def test_text_that_would_not_be_read_back_is_rejected(data: bytes, key: str, value: str) -> None:
    conf = ConfFile(data)
    with pytest.raises(InputError, match="cannot hold"):
        conf.set_value(key, value)
    assert conf.format() == data


@pytest.mark.verifies("SWR-PFL-007", technique="error_guessing")
def test_many_keys_take_no_long_time() -> None:
    conf = ConfFile(b"".join(b"key%d: 1\n" % number for number in range(40_000)))

    assert (len(conf.entries), conf.deviations, conf.get_value("key39999")) == (40_000, [], "1")


@pytest.mark.verifies("SWR-PFL-007", technique="error_guessing")
@pytest.mark.parametrize("line", [b"a" + b" " * 300_000, b"\\" * 300_001, b"a" * 300_000], ids=("spaces", "signs", "letters"))
def test_a_long_line_takes_no_long_time(line: bytes) -> None:
    conf = ConfFile(line + b"\nb: 1\n")

    assert conf.get_value("b" if b"\\" not in line else "\\" * 150_000 + "b") == "1"


@pytest.mark.verifies("SWR-PFL-007")
def test_the_first_entry_of_an_empty_file_can_be_set() -> None:
    conf = ConfFile(b"")
    conf.set_value("a", "1")

    assert conf.format() == b"a: 1\n"


@pytest.mark.verifies("SWR-PFL-007", polarity="violation")
@pytest.mark.parametrize(("data", "number", "line", "place"), [
    (b"a: 1\nb: 2\na: 3\n", "D21", 3, "a"), (b"a: 1\nb\n", "D22", 2, "b"), (b"a: 1\n: 2\n", "D22", 2, ": 2"), (b"a: 1\n# \x83\n", "D23", 2, "byte 0x83"),
    (b"a: 1, \\", "D24", 1, ""), (b"a: 1, \\\n# end\n", "D24", 1, ""),
])  # fmt: skip
def test_deviations_are_violations_unless_they_are_tolerated(tmp_path: Path, data: bytes, number: str, line: int, place: str) -> None:
    path = tmp_path / "rtc.conf"
    path.write_bytes(data)
    tolerant = load_profile(path, tolerant=True)

    assert [(deviation.id, deviation.line, deviation.place) for deviation in tolerant.deviations] == [(number, line, place)]
    assert tolerant.violations == []
    assert [violation.line for violation in load_profile(path).violations] == [line]
    assert tolerant.conf is not None
    assert tolerant.conf.get_value("a") == ("3" if number == "D21" else "1," if number == "D24" else "1")
