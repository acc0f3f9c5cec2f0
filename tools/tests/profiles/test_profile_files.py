# SPDX-License-Identifier: Apache-2.0
# Goal: files are read and written without loss; files that are damaged or dangerous give one error with their line.
from __future__ import annotations

from pathlib import Path

import pytest
from profile_samples import CONF, RTC_03, RTS_02, SAMPLES

from mamori_tools.profiles.convert import convert
from mamori_tools.profiles.profile import load_profile
from mamori_tools.profiles.view import RtcView, RtsView
from mamori_tools.profiles.xml_file import ATTRIBUTES_MAX, ELEMENTS_MAX, MAX_BYTES, canonicalize, format_xml, parse_xml
from mamori_trace.base.errors import InputError

SHARED = Path(__file__).resolve().parents[3] / "../shared/data/profiles"


def write(folder: Path, data: bytes, name: str = "profile.xml") -> Path:
    path = folder / name
    path.write_bytes(data)
    return path


@pytest.mark.verifies("SWR-PFL-001", technique="back_to_back")
@pytest.mark.parametrize("name", SAMPLES)
def test_a_tree_is_written_with_the_same_canonical_form(tmp_path: Path, name: str) -> None:
    path = write(tmp_path, SAMPLES[name].encode())
    tree = load_profile(path).root.getroottree()

    assert canonicalize(parse_xml(format_xml(tree), path)) == canonicalize(parse_xml(path.read_bytes(), path))


@pytest.mark.verifies("SWR-PFL-004", technique="equivalence_classes")
@pytest.mark.parametrize("data", [RTC_03.encode(), RTC_03.replace("\n", "\r\n").encode(), b"\xef\xbb\xbf" + RTC_03.encode(),
                                  RTC_03.replace("UTF-8", "UTF-16").encode("utf-16"), RTC_03.replace("UTF-8", "Shift_JIS").encode("shift_jis")])  # fmt: skip
def test_line_ends_and_encodings_do_not_change_the_content(tmp_path: Path, data: bytes) -> None:
    profile = load_profile(write(tmp_path, data))

    assert profile.violations == []
    assert RtcView(profile.root, profile.table).basic.get_value("abstract") == "モータ"


@pytest.mark.verifies("SWR-PFL-001")
@pytest.mark.parametrize(("data", "name"), [(RTC_03.replace('"t"', "'t'").encode(), "x.xml"), (CONF, "rtc.conf")])
def test_an_unchanged_file_is_written_with_the_same_bytes(tmp_path: Path, data: bytes, name: str) -> None:
    content, losses = convert(load_profile(write(tmp_path, data, name)), tmp_path / name)

    assert content == data
    assert losses == []


@pytest.mark.verifies("SWR-PFL-001")
def test_a_change_of_one_value_leaves_the_rest(tmp_path: Path) -> None:
    profile = load_profile(write(tmp_path, RTC_03.encode()))
    RtcView(profile.root, profile.table).configurations[0].set_value("variableName", "m_other")

    changed = canonicalize(profile.root.getroottree())
    assert changed == canonicalize(parse_xml(RTC_03.replace('"m_gain"', '"m_other"').encode(), profile.path))
    with pytest.raises(KeyError):
        RtcView(profile.root, profile.table).basic.set_value("position", "LEFT")


@pytest.mark.verifies("SWR-PFL-001")
def test_views_name_the_parts_of_a_component(tmp_path: Path) -> None:
    profile = load_profile(write(tmp_path, RTC_03.encode()))
    view = RtcView(profile.root, profile.table)

    assert {name: part.get_value("implemented") for name, part in view.actions.items()} == {"OnInitialize": "true", "OnExecute": "true"}
    assert view.actions["OnExecute"].get_documentation("description") == "moves"
    assert view.actions["OnInitialize"].get_documentation("description") == ""
    assert [port.name for port in view.data_ports] == ["speed", "event"]
    assert view.service_ports[0].list_parts("ServiceInterface")[0].get_value("direction") == "Provided"
    assert view.basic.properties == {"FSM": "true"}
    assert view.language == "C++"


@pytest.mark.verifies("SWR-PFL-001")
@pytest.mark.parametrize("name", ["rts_0_2.xml", "rts_0_1.xml"])
def test_views_name_the_parts_of_a_system(tmp_path: Path, name: str) -> None:
    profile = load_profile(write(tmp_path, SAMPLES[name].encode()))
    view = RtsView(profile.root, profile.table)
    source, target = view.get_ends(view.connectors[0])

    assert (source.get_value("portName") if source else None) == ("Sensor0.out" if "0_2" in name else None)
    assert target.get_value("instanceName") == "Motor0"
    assert view.components[-1].line == profile.data[: profile.data.index(b'instanceName="Motor0"')].count(b"\n") + 1
    assert {order: len(targets) for order, targets in view.orders.items()} == ({"StartUp": 2} if "0_2" in name else {})


BOMB = '<!DOCTYPE a [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;&a;&a;">]>\n'
NAMES = b'<?xml version="1.0" encoding="latin-9000"?>\n<a/>'


@pytest.mark.verifies("SWR-PFL-004", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(("data", "line", "message"), [
    (RTC_03.replace("<!-- a motor -->", BOMB).encode(), 2, "has a document type"),
    (RTC_03.replace("<!-- a motor -->", '<!-- <!DOCTYPE --><?a <!DOCTYPE?>\n<!DOCTYPE a SYSTEM "http://example.invalid/a.dtd">').encode(), 3, "document type"),
    (RTC_03.replace("<!-- a motor -->", BOMB).replace("UTF-8", "UTF-16").encode("utf-16"), 2, "has a document type"),
    (RTC_03[: len(RTC_03) // 2].encode(), 23, "not well-formed XML"),
    (RTC_03.replace('rtc:name="Motor"', 'rtc:name="&undefined;"').encode(), 4, "not well-formed XML"),
    (RTC_03.replace('rtc:name="Motor"', 'rtc:name="\x01"').encode(), 4, "not well-formed XML"),
    (RTC_03.encode("shift_jis"), 6, "is not valid UTF-8"),
    (NAMES, 1, "unknown encoding latin-9000"),
    (NAMES.replace(b"latin-9000", b"undefined"), 1, "unknown encoding undefined"),
    (NAMES.replace(b"latin-9000", b"punycode"), 1, "unknown encoding punycode"),
    ("<a/>".encode("utf-16-le"), 1, "is not XML text in utf-8"),
    (b"<!-- -->\n<a>\0</a>", 2, "is not XML text in utf-8"),
    (NAMES.replace(b"latin-9000", b"UTF-16"), 1, "is not XML text in UTF-16"),
    (b"rtsProfile:\n  id: \xef\xbf\xbe\n", 2, "cannot be part of a profile|not text in UTF-8"),
    (b'rtsProfile:\n  id: "\\uFFFF"\n', 2, "cannot be part of a profile"),
    (b"rtsProfile:\n  xsi::type: [1]\n", 2, "a single value is expected"),
    (b"<html><body/></html>", 1, "is XML, but not a profile"),
    (b"rtsProfile:\n  id: [\n", 3, "not well-formed YAML"),
    (b"rtsProfile:\n  id: &a x\n  version: *a\n", 3, "has an alias"),
    (b"rtsProfile:\n " + b"{a: " * 40, 2, "nested deeper than 32 levels"),
    (b"rtsProfile:\n  id: a\n  id: b\n", 3, "occurs more than once"),
    (b"rtsProfile:\n  id: a\n  components: 5\n", 3, "a list is expected"),
    (b"rtsProfile:\n  id: a\n  creationDate: {year: x}\n", 3, "a date is a map of integers"),
    (b"rtsProfile: x\n", 1, "a map of keys and values is expected"),
    (b"rtsProfile:\n  id: \xff\n", 2, "not text in UTF-8"),
    (b"corba.a: 1\n\0\n", 2, "has a zero byte"),
    (b"\n\nNote: a text\n", None, "not a profile"),
    (b"def f():\n    x: int = 3\n", None, "not a profile"),
])  # fmt: skip
def test_a_damaged_or_dangerous_file_gives_one_error_with_its_line(tmp_path: Path, data: bytes, line: int | None, message: str) -> None:
    path = write(tmp_path, data, "profile")
    with pytest.raises(InputError, match=message) as caught:
        load_profile(path, tolerant=True)

    assert (caught.value.path, caught.value.line) == (path, line)
    assert "\n" not in str(caught.value)


@pytest.mark.verifies("SWR-PFL-004", polarity="violation")
@pytest.mark.parametrize(("data", "message"), [(b"", "is empty"), (b" \n", "is empty"), (b"some text\n", "not a profile"), (None, "not found")])
def test_what_is_not_a_profile_is_rejected(tmp_path: Path, data: bytes | None, message: str) -> None:
    path = tmp_path / "profile" if data is None else write(tmp_path, data, "profile")
    with pytest.raises(InputError, match=message):
        load_profile(path)


@pytest.mark.verifies("SWR-PFL-004", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("extra", "is_read"), [(0, True), (1, False)])
def test_a_file_of_the_maximum_size_is_read(tmp_path: Path, extra: int, is_read: bool) -> None:
    data = b"<a>" + b" " * (MAX_BYTES - 7 + extra) + b"</a>"
    with pytest.raises(InputError, match="not a profile" if is_read else "larger than 8000000 bytes"):
        load_profile(write(tmp_path, data))


@pytest.mark.verifies("SWR-PFL-004", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("text", "is_read"), [
    ("<a>\n" + "<b/>" * (ELEMENTS_MAX - 1) + "</a>", True), ("<a>\n" + "<b/>" * ELEMENTS_MAX + "</a>", False),
    ("<a>\n<b " + " ".join(f"a{number}='>=\"'" for number in range(ATTRIBUTES_MAX)) + ">a='1'</b></a>", True),
    ("<a>\n<b " + " ".join(f"a{number}='>=\"'" for number in range(ATTRIBUTES_MAX + 1)) + "/></a>", False),
])  # fmt: skip
def test_the_numbers_of_elements_and_attributes_are_limited(tmp_path: Path, text: str, is_read: bool) -> None:
    with pytest.raises(InputError, match="but not a profile" if is_read else "has more than (20000 elements|256 attributes in an element)") as caught:
        load_profile(write(tmp_path, text.encode()))
    assert caught.value.line == (1 if is_read else 2)


@pytest.mark.verifies("SWR-PFL-002", technique="error_guessing", polarity="violation")
def test_each_of_many_violations_has_its_place(tmp_path: Path) -> None:
    space = 'xmlns="http://www.openrtp.org/namespaces/rtc"'
    ports = "".join(f'<rtc:DataPorts rtc:name="{number}"/>' for number in range(300))
    violations = load_profile(write(tmp_path, RTC_03.replace("</rtc:Actions>", f"</rtc:Actions>{ports}<DataPorts {space}/>").encode())).violations

    assert {f"DataPorts[{number}]" for number in range(300)} | {"DataPorts"} <= {violation.place for violation in violations}


@pytest.mark.skipif(not SHARED.is_dir(), reason=f"{SHARED} not found")
def test_public_files_are_written_without_loss() -> None:
    for path in sorted([*SHARED.glob("rt[cs]/*"), *SHARED.glob("rtcconf/*")]):
        profile = load_profile(path)
        if profile.conf is not None:
            assert profile.conf.format() == profile.data, path
        elif profile.form == "xml":
            tree = profile.root.getroottree()
            assert canonicalize(parse_xml(format_xml(tree), path)) == canonicalize(parse_xml(profile.data, path)), path


def test_the_samples_are_text_of_one_form(tmp_path: Path) -> None:
    assert load_profile(write(tmp_path, RTS_02.encode())).title == "RTS profile 0.2"
    assert load_profile(write(tmp_path, CONF, "any")).title == "rtc.conf"
