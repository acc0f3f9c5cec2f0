# SPDX-License-Identifier: Apache-2.0
# Goal: the command has the documented exit statuses and output. Method: files in a temporary folder.
from __future__ import annotations

import json
from pathlib import Path

import pytest
from profile_samples import CONF, MOTOR, RTC_01, RTC_03, RTS_01, RTS_02

from mamori_tools.command.main import main
from mamori_tools.profiles.packages import KEYS, find_packages, resolve_components, select
from mamori_tools.profiles.profile import load_profile
from mamori_trace.base.errors import InputError

SENSOR_RTC = RTC_03.replace("Motor", "Sensor").replace("RTC::TimedDouble", "RTC::TimedLong").replace("C++", "Python")
WRONG_RTC = RTC_03.replace('"Provided"', '"PROVIDED"')


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name, text in {"motor/RTC.xml": RTC_03, "sensor/RTC.xml": SENSOR_RTC, "RTS.xml": RTS_02, "wrong.xml": WRONG_RTC, "cut.xml": RTC_03[:900],
                       "rtc.conf": CONF.decode()}.items():  # fmt: skip
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_bytes(text.encode())
    return tmp_path


def run(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    status = main(["profile", *words])
    shown = capsys.readouterr()
    return status, shown.out, shown.err


@pytest.mark.verifies("SWR-PFL-003")
@pytest.mark.parametrize(("words", "status", "out"), [
    (["motor/RTC.xml"], 0, "motor/RTC.xml: RTC profile 0.3: valid\n"),
    (["rtc.conf"], 0, "rtc.conf: rtc.conf: valid\n"),
    (["wrong.xml"], 1, "wrong.xml:37: ServicePorts[service]/ServiceInterface[reset]: Element 'rtc:ServiceInterface', attribute 'rtc:direction': [facet "
     "'enumeration'] The value 'PROVIDED' is not an element of the set {'Provided', 'Required'}.\nwrong.xml: RTC profile 0.3: invalid, 1 violation\n"),
    (["wrong.xml", "--tolerant"], 0, "wrong.xml:37: deviation D05: ServicePorts[service]/ServiceInterface[reset]: a value differs in case or spelling from an "
     "allowed value: rtc:direction='PROVIDED' read as 'Provided'\nwrong.xml: RTC profile 0.3: valid with 1 deviation\n"),
])  # fmt: skip
def test_check_has_the_status_of_the_verdict(folder: Path, capsys: pytest.CaptureFixture[str], words: list[str], status: int, out: str) -> None:
    assert run(capsys, "check", *words) == (status, out, "")


@pytest.mark.verifies("SWR-PFL-003", polarity="violation")
def test_check_of_an_unreadable_file_is_one_line_and_status_2(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = run(capsys, "check", "cut.xml", "--json")

    assert (status, out) == (2, "")
    assert err.startswith("mamori: cut.xml:8: not well-formed XML: ")
    assert err.count("\n") == 1


@pytest.mark.verifies("SWR-PFL-003")
def test_check_prints_json_with_notes(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("RTS.xml").write_text(RTS_02.replace("RTSystem:Mamori:Drive:1.0.0", "Drive").replace('rts:direction="RIGHT"', ""), encoding="utf-8")
    status, out, _ = run(capsys, "check", "RTS.xml", "--json")
    tolerant = json.loads(run(capsys, "check", "wrong.xml", "--json", "--tolerant")[1])

    assert status == 0
    assert json.loads(out) == {
        "file": "RTS.xml", "profile": "rts", "form": "xml", "version": "0.2", "mode": "strict", "valid": True, "violations": [], "deviations": [],
        "notes": [{"id": "N04", "line": 3, "place": "rts:RtsProfile", "repair": "Drive", "sentence": "the id does not have the usual form"}]}  # fmt: skip
    assert (tolerant["mode"], [deviation["id"] for deviation in tolerant["deviations"]]) == ("tolerant", ["D05"])


@pytest.mark.verifies("SWR-PFL-008")
def test_show_names_the_fields_with_a_value(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, out, _ = run(capsys, "show", "motor/RTC.xml")

    assert status == 0
    assert "\nconfiguration\n  parameter name                 gain\n" in out
    assert "\n  constraint                     0<=x<=2\n" in out
    assert any(line.split() == ["OnExecute", "overview", "moves"] for line in out.splitlines())
    assert "\nlanguage and environment\n  language             C++\n" in out


@pytest.mark.verifies("SWR-PFL-008")
@pytest.mark.parametrize(("text", "name", "lines"), [
    (RTS_02, "RTS.xml", ["component Motor0", "  context 0    PERIODIC 1000.0", "  set default  gain=1.50", "connector line",
                         "  ends              Sensor0.out -> Motor0.in", "StartUp", "  1  Motor0", "  2  Sensor0"]),
    (RTS_01, "RTS.xml", ["  context     PERIODIC 1000.0", "  dataType      TimedLong"]),
    (CONF.decode(), "a.conf", ["  manager.modules.load_path        ./, ../lib"]),
])  # fmt: skip
def test_show_lists_the_parts_of_a_system_and_the_keys_of_rtc_conf(
    folder: Path, capsys: pytest.CaptureFixture[str], text: str, name: str, lines: list[str]
) -> None:
    Path(name).write_bytes(text.encode())
    status, out, _ = run(capsys, "show", name)

    assert status == 0
    assert set(lines) <= set(out.splitlines())
    assert "values" in json.loads(run(capsys, "show", name, "--json")[1])


@pytest.mark.verifies("SWR-PFL-010")
def test_convert_writes_the_yaml_form_and_back(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "convert", "RTS.xml", "--out", "RTS.yaml") == (0, "", "mamori: wrote RTS.yaml\n")
    assert run(capsys, "convert", "RTS.yaml", "--out", "again.xml")[0] == 0

    assert run(capsys, "check", "again.xml")[0] == 0
    assert run(capsys, "diff", "RTS.xml", "again.xml") == (0, "", "")


@pytest.mark.verifies("SWR-PFL-010")
def test_convert_of_a_tolerated_file_names_what_it_changed(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, _, err = run(capsys, "convert", "wrong.xml", "--out", "right.xml", "--tolerant")

    assert status == 0
    assert err.splitlines()[0].startswith("mamori: wrong.xml:37: D05: ")
    assert run(capsys, "check", "right.xml")[0] == 0
    assert run(capsys, "convert", "RTS.xml", "--out", "p.xml", "--portable")[2] == "mamori: not kept: rts:creationDate: .250+09:00\nmamori: wrote p.xml\n"
    assert run(capsys, "diff", "RTS.xml", "p.xml")[1] == "~ @creationDate: 2026-01-02T03:04:05.250+09:00 -> 2026-01-02T03:04:05\n"


@pytest.mark.verifies("SWR-PFL-010", polarity="violation")
@pytest.mark.parametrize("words", [["convert", "wrong.xml", "--out", "out.xml"], ["show", "wrong.xml"], ["diff", "wrong.xml", "wrong.xml"]])
def test_an_invalid_file_is_not_status_0_and_nothing_is_written(folder: Path, capsys: pytest.CaptureFixture[str], words: list[str]) -> None:
    status, out, err = run(capsys, *words)

    assert (status, out, Path("out.xml").exists()) == (2 if words[0] == "diff" else 1, "", False)
    assert err.startswith("mamori: wrong.xml:37: ServicePorts[service]")
    assert err.endswith("correct the file or add --tolerant\n")


@pytest.mark.verifies("SWR-PFL-010", polarity="violation")
def test_a_file_that_cannot_be_written_is_status_2(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, _, err = run(capsys, "convert", "RTS.xml", "--out", "missing/RTS.yaml")

    assert (status, err.count("\n")) == (2, 1)
    assert "missing/RTS.yaml" in err


@pytest.mark.verifies("SWR-PFL-011")
def test_diff_shows_what_was_changed_added_and_removed(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = RTC_03.replace('rtc:unit="1" ', "").replace("slider.0.01", "spin").replace('rtc:category="test"', 'rtc:category="a"')
    Path("new.xml").write_text(text, encoding="utf-8")
    status, out, _ = run(capsys, "diff", "motor/RTC.xml", "new.xml")

    assert status == 1
    assert out.splitlines() == ["~ BasicInfo/@category: test -> a", "- ConfigurationSet/Configuration[gain]/@unit: 1",
                                "~ ConfigurationSet/Configuration[gain]/Properties[__widget__]/@value: slider.0.01 -> spin"]  # fmt: skip
    assert json.loads(run(capsys, "diff", "new.xml", "motor/RTC.xml", "--json")[1])["differences"][2] == {
        "place": "ConfigurationSet/Configuration[gain]/@unit", "first": None, "second": "1"}  # fmt: skip
    assert run(capsys, "diff", "new.xml", "motor/RTC.xml")[1].splitlines()[2] == "+ ConfigurationSet/Configuration[gain]/@unit: 1"


@pytest.mark.verifies("SWR-PFL-011")
def test_diff_ignores_order_layout_and_extension_types(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    action = '    <rtc:OnInitialize rtc:implemented="true"/>\n'
    first, second = (RTC_03.index(f'  <rtc:DataPorts xsi:type="rtcExt:dataport_ext" rtc:name="{name}"') for name in ("speed", "event"))
    port = RTC_03[first:second]
    text = RTC_03.replace(port, "").replace("  <rtc:ServicePorts", f"{port}  <rtc:ServicePorts").replace(action, action.strip())
    Path("new.xml").write_text(text, encoding="utf-8")

    assert run(capsys, "diff", "motor/RTC.xml", "new.xml") == (0, "", "")


@pytest.mark.verifies("SWR-PFL-011")
def test_diff_compares_numbers_booleans_and_dates_by_value(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = RTC_03.replace('"1000.0"', '"1e3"').replace('implemented="true"', 'implemented="1"').replace('maxInstances="2"', 'maxInstances=" +2"')
    Path("new.xml").write_text(text.replace("2026-01-02T03:04:05Z", "2026-01-02T04:04:05.0+01:00"), encoding="utf-8")

    assert run(capsys, "diff", "motor/RTC.xml", "new.xml") == (0, "", "")


@pytest.mark.verifies("SWR-PFL-005")
def test_show_and_diff_name_the_deviations(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("new.xml").write_text(RTC_03.replace("<rtc:BasicInfo", '<rtc:BasicInfo rtc:colour="red"'), encoding="utf-8")

    for words in (["diff", "motor/RTC.xml", "new.xml"], ["show", "new.xml"]):
        status, out, err = run(capsys, *words, "--tolerant")
        assert (status, err) == (0, "mamori: new.xml:7: D07: BasicInfo: the attribute is unknown: rtc:colour ignored\n")
        assert "D07" not in out
        content = json.loads(run(capsys, *words, "--tolerant", "--json")[1])
        assert [own["id"] for own in content["deviations"]] == ["D07"]


@pytest.mark.verifies("SWR-PFL-010", technique="error_guessing")
@pytest.mark.parametrize(("old", "new"), [('rts:version="0.2"', 'rts:version="0.1"'), ('rts:version="0.2"', 'rts:version="9"'), (' rts:version="0.2"', "")])
def test_a_tolerated_file_is_written_with_the_version_that_was_read(folder: Path, capsys: pytest.CaptureFixture[str], old: str, new: str) -> None:
    Path("RTS.xml").write_text(RTS_02.replace(old, new), encoding="utf-8")

    assert run(capsys, "convert", "RTS.xml", "--out", "out.XML", "--tolerant")[0] == 0
    assert run(capsys, "check", "out.XML") == (0, "out.XML: RTS profile 0.2: valid\n", "")
    assert Path("out.XML").read_bytes().endswith(b">\n")


@pytest.mark.verifies("SWR-PFL-010", polarity="violation")
def test_a_yaml_form_of_another_version_does_not_become_xml(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run(capsys, "convert", "RTS.xml", "--out", "RTS.YAML")
    text = Path("RTS.YAML").read_text(encoding="utf-8")
    Path("RTS.YAML").write_text(text.replace("version: '0.2'", "version: '0.1'"), encoding="utf-8")
    status, _, err = run(capsys, "convert", "RTS.YAML", "--out", "out.xml")

    assert (status, Path("out.xml").exists()) == (2, False)
    assert "would be invalid" in err
    assert run(capsys, "convert", "RTS.YAML", "--out", "out.xml", "--tolerant")[0] == 0
    assert run(capsys, "check", "out.xml")[0] == 0


@pytest.mark.verifies("SWR-PFL-003", technique="boundary_values")
@pytest.mark.parametrize("count", [1000, 1001])
def test_at_most_1000_violations_are_printed(folder: Path, capsys: pytest.CaptureFixture[str], count: int) -> None:
    Path("a.conf").write_text("key\n" + "".join(f"k{number}\n" for number in range(count - 1)), encoding="utf-8")
    status, out, _ = run(capsys, "check", "a.conf")

    assert (status, len(out.splitlines())) == (1, count + 1)
    assert out.endswith(f"a.conf: rtc.conf: invalid, {count} violations\n")
    assert ("a.conf: 1 more, see --json\n" in out) is (count == 1001)


@pytest.mark.verifies("SWR-PFL-011", polarity="violation")
def test_diff_of_two_kinds_is_rejected(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    status, _, err = run(capsys, "diff", "RTS.xml", "rtc.conf")

    assert (status, err) == (2, "mamori: profile diff: RTS.xml is an RTS profile 0.2, rtc.conf an rtc.conf; compare profiles of one kind\n")


@pytest.mark.verifies("SWR-PFL-012")
@pytest.mark.parametrize(("words", "found"), [
    ([], ["motor", "sensor"]), (["name=motor"], ["motor"]), (["data-type=*timedlong"], ["sensor"]), (["language=c++", "vendor=M*"], ["motor"]),
    (["parameter=gain", "service=reset", "port=event"], ["motor", "sensor"]), (["name=motor", "language=Python"], []),
    (["id=RTC:*"], ["motor", "sensor"]), (["service-type=Re?et", "component-type=static", "activity-type=PERIODIC"], ["motor", "sensor"]),
])  # fmt: skip
def test_find_lists_the_packages_that_match_every_pattern(folder: Path, capsys: pytest.CaptureFixture[str], words: list[str], found: list[str]) -> None:
    for name in ("wrong.xml", "cut.xml"):
        Path(name).unlink()
    status, out, err = run(capsys, "find", ".", *words)

    assert (status, err) == (0 if found else 1, "")
    assert [line.split()[1] for line in out.splitlines()] == [f"{name}/RTC.xml" for name in found]


@pytest.mark.verifies("SWR-PFL-012")
def test_find_reads_packages_with_deviations_but_not_hidden_ones(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("odd", ".hidden", "build"):
        Path(name).mkdir()
        Path(name, "RTC.xml").write_text(WRONG_RTC.replace("Motor", "Odd"), encoding="utf-8")
    Path("odd/RTC.xml").write_text(WRONG_RTC.replace("Motor", "Odd").replace("UTF-8", "UTF-16"), encoding="utf-16")

    assert run(capsys, "find", ".", "name=Odd")[:2] == (0, "RTC:Mamori:test:Odd:1.0.0  odd/RTC.xml\n")


@pytest.mark.verifies("SWR-PFL-012")
def test_find_reads_a_long_comment_any_case_and_each_pattern(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("builder", "build-host"):
        Path(name).mkdir()
        Path(name, "RTC.XML").write_text(RTC_03.replace("<!-- a motor -->", f"<!-- {'licence' * 2000} -->").replace("Motor", "Long"), encoding="utf-8")
    Path("text.xml").write_text("<a>RtcProfile</a>", encoding="utf-8")

    assert run(capsys, "find", ".", "name=Long")[:2] == (0, "RTC:Mamori:test:Long:1.0.0  builder/RTC.XML\n")
    assert run(capsys, "find", ".", "name=L*", "name=M*")[:2] == (1, "")
    assert "text.xml" not in run(capsys, "find", ".")[2]


@pytest.mark.verifies("SWR-PFL-012")
def test_each_key_has_values(folder: Path) -> None:
    packages, _ = find_packages(folder / "motor")

    assert all(len(select(packages, [(key, "*")])) == 1 for key in KEYS)


@pytest.mark.verifies("SWR-PFL-012", polarity="violation")
def test_find_names_files_that_cannot_be_used_and_continues(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("wrong.xml").write_text(RTC_03.replace('rtc:portType="DataInPort" ', ""), encoding="utf-8")
    status, out, err = run(capsys, "find", ".", "name=Motor")

    assert (status, out) == (0, f"{MOTOR}  motor/RTC.xml\n")
    assert [line.split(": ")[1] for line in err.splitlines()] == ["cut.xml:8", "wrong.xml:29"]


@pytest.mark.verifies("SWR-PFL-012", polarity="violation")
@pytest.mark.parametrize(("words", "message"), [
    (["missing"], "missing: not a folder"), ([".", "nam=x"], "there is no key 'nam'; nearest: name"), ([".", "name"], "'name' is not KEY=PATTERN"),
    ([".", "name=x", "--system", "RTS.xml"], "--system needs no KEY=PATTERN"), ([".", "--system", "motor/RTC.xml"], "not an RTS profile that can be used"),
])  # fmt: skip
def test_find_rejects_wrong_arguments(folder: Path, capsys: pytest.CaptureFixture[str], words: list[str], message: str) -> None:
    status, out, err = run(capsys, "find", *words)

    assert (status, out) == (2, "")
    assert message in err.splitlines()[-1]


@pytest.mark.verifies("SWR-PFL-013")
def test_components_resolve_to_their_packages(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("cut.xml").unlink()
    Path("wrong.xml").unlink()
    assert run(capsys, "find", ".", "--system", "RTS.xml") == (0, "Sensor0  sensor/RTC.xml\nMotor0   motor/RTC.xml\n", "")
    assert json.loads(run(capsys, "find", ".", "--system", "RTS.xml", "--json")[1])[0] == {"instance": "Sensor0", "file": "sensor/RTC.xml"}


@pytest.mark.verifies("SWR-PFL-013")
def test_ids_of_version_0_1_resolve_too(folder: Path) -> None:
    Path("old").mkdir()
    Path("old/RTC.xml").write_text(RTC_01, encoding="utf-8")
    Path("RTS.xml").write_text(RTS_01, encoding="utf-8")
    packages, _ = find_packages(Path("old"))

    assert {name: str(package.path) for name, package in resolve_components(load_profile(Path("RTS.xml")), packages).items()} == {"Motor0": "old/RTC.xml"}
    assert [package.id for package in find_packages(Path("motor"))[0]] == [MOTOR]


@pytest.mark.verifies("SWR-PFL-013", polarity="violation")
@pytest.mark.parametrize(("change", "line", "message"), [
    ("unknown", 12, "no package has the id RTC:Mamori:test:Motor:1.0.0 of Motor0; nearest: RTC:Mamori:test:Sensor:1.0.0"),
    ("double", 12, "2 packages have the id RTC:Mamori:test:Motor:1.0.0 of Motor0: copy/RTC.xml, motor/RTC.xml; remove one"),
    ("name", 12, "the instance Sensor0 occurs more than once; rename one"),
])  # fmt: skip
def test_unknown_and_double_ids_are_rejected_with_file_and_line(folder: Path, change: str, line: int, message: str) -> None:
    if change == "unknown":
        Path("motor/RTC.xml").unlink()
        Path("wrong.xml").unlink()
    elif change == "double":
        Path("wrong.xml").unlink()
        Path("copy").mkdir()
        Path("copy/RTC.xml").write_text(RTC_03, encoding="utf-8")
    else:
        Path("RTS.xml").write_text(RTS_02.replace("Motor0", "Sensor0"), encoding="utf-8")
    packages, _ = find_packages(Path("."))

    with pytest.raises(InputError) as caught:
        resolve_components(load_profile(Path("RTS.xml")), packages)
    assert str(caught.value).startswith(f"RTS.xml:{line}: {message}")


@pytest.mark.verifies("SWR-PFL-003", polarity="violation")
@pytest.mark.parametrize(("words", "message"), [
    (["check", "RTS.xml", "rtc.conf"], "2 paths instead of 1"), (["diff", "RTS.xml"], "1 paths instead of 2"), (["convert", "RTS.xml"], "convert needs --out"),
    (["show", "RTS.xml", "--out", "x.xml"], "--out is for convert; omit it"), (["show", "RTS.xml", "--system", "RTS.xml"], "--system is for find"),
    (["find", ".", "--tolerant"], "--tolerant is for check, show, convert, diff"), (["convert", "RTS.xml", "--out", "x.xml", "--json"], "--json is for"),
    (["check", "RTS.xml", "--schema", "nothing"], "nothing: not found"), (["check", "RTS.xml", "--schema", "RTS.xml"], "RTS.xml: not a folder"),
    (["convert", "RTS.xml", "--out", "x.json"], "names no form"), (["check", "RTS.xml", "--schema", "."], "has no RtsProfile_ext.xsd"),
    (["check", "missing.xml"], "missing.xml: not found"),
])  # fmt: skip
def test_wrong_arguments_are_one_line_and_status_2(folder: Path, capsys: pytest.CaptureFixture[str], words: list[str], message: str) -> None:
    status, out, err = run(capsys, *words)

    assert (status, out, err.count("\n")) == (2, "", 1)
    assert message in err
