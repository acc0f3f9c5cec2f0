# SPDX-License-Identifier: Apache-2.0
# Goal: the tolerant mode loads what tools write and names each deviation; it does not invent what the file does not say.
# Method: one edit of a small own profile per kind of deviation; with the public files next to the project, those files and seeded changes.
from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from profile_mutations import mutate
from profile_samples import RTC_01, RTC_02, RTC_03, RTC_SPACES, RTS_01, RTS_02, SAMPLES

from mamori_tools.profiles.attribute_value import find_meant, is_of_type
from mamori_tools.profiles.deviation import DEVIATIONS, NOTES
from mamori_tools.profiles.notes import list_notes
from mamori_tools.profiles.profile import load_profile
from mamori_tools.profiles.repair import repair
from mamori_tools.profiles.schema_table import list_versions, load_table

SHARED = Path(__file__).resolve().parents[3] / "../shared/data/profiles"


def write(folder: Path, text: str, name: str = "profile.xml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


FOLLOWING = {"D02": ("D01",), "D10": ("D04",), "D14": ("D04",)}
"""Deviations of the same cause."""


@pytest.mark.verifies("SWR-PFL-005", technique="equivalence_classes")
@pytest.mark.parametrize(("sample", "old", "new", "number", "repair_"), [
    (RTS_02, ' xsi:type="rtsExt:component_ext"', "", "D01", "xsi:type rtsExt:component_ext added"),
    (RTS_02, ' xsi:type="rtsExt:rts_profile_ext"', "", "D01", "xsi:type rtsExt:rts_profile_ext added"),
    (RTC_03, '"rtcDoc:action_status_doc"', '"rtcDoc:other"', "D02", "xsi:type rtcDoc:other ignored"),
    (RTC_03, '"rtcDoc:action_status_doc"', '"action_status_doc"', "D02", "xsi:type action_status_doc ignored"),
    (RTS_02, '    <rts:ExecutionContexts xsi:type="rtsExt:execution_context_ext" rts:id="0" rts:kind="PERIODIC" rts:rate="1000.0"/>\n'
     '    <rtsExt:Location rtsExt:x="1" rtsExt:y="2" rtsExt:height="-1" rtsExt:width="-1" rtsExt:direction="RIGHT"/>',
     '    <rtsExt:Location rtsExt:x="1" rtsExt:y="2" rtsExt:height="-1" rtsExt:width="-1" rtsExt:direction="RIGHT"/>\n'
     '    <rts:ExecutionContexts xsi:type="rtsExt:execution_context_ext" rts:id="0" rts:kind="PERIODIC" rts:rate="1000.0"/>', "D03", "sorted"),
    (RTS_02, ' rts:updateDate="2026-01-02T03:04:05"', "", "D04", "rts:updateDate='2026-01-02T03:04:05.250+09:00' added"),
    (RTC_03, ' rtcExt:position="LEFT"', "", "D04", "rtcExt:position='LEFT' added"),
    (RTS_02, ' rts:interfaceType="corba_cdr"', "", "D04", "rts:interfaceType='' added"),
    (RTC_03, '"Provided"', '"PROVIDED"', "D05", "rtc:direction='PROVIDED' read as 'Provided'"),
    (RTC_03, '"PERIODIC"', '"PERIODOC"', "D05", "rtc:activityType='PERIODOC' read as 'PERIODIC'"),
    (RTC_03, '"PERIODIC"', '"EVENT_DRIVEN"', "D05", "rtc:activityType='EVENT_DRIVEN' read as 'EVENTDRIVEN'"),
    (RTC_03, 'OnInitialize rtc:implemented="true"', 'OnInitialize rtc:implemented="True"', "D05", "rtc:implemented='True' read as 'true'"),
    (RTC_03, 'maxInstances="2"', 'maxInstances="2.0"', "D05", "rtc:maxInstances='2.0' read as '2'"),
    (RTC_03, 'maxInstances="2"', 'maxInstances=""', "D06", "rtc:maxInstances='' ignored"),
    (RTC_03, 'executionRate="1000.0"', 'executionRate="1 kHz"', "D06", "rtc:executionRate='1 kHz' ignored"),
    (RTC_03, 'rtc:rtcType="t"', 'rtc:colour="red"', "D07", "rtc:colour ignored"),
    (RTC_03, "<rtc:UpperBoundary>", '<rtc:UpperBoundary rtc:unit="m">', "D07", "rtc:unit ignored"),
    (RTC_03, "  </rtc:Actions>", "    <rtc:OnSomething/>\n  </rtc:Actions>", "D08", "ignored"),
    (RTC_03, "<rtc:UpperBoundary>2", "<rtc:UpperBoundary><rtc:Literal/>2", "D08", "ignored"),
    (RTC_03, "rtcDoc:occerrence", "rtcDoc:occurrence", "D09", "rtcDoc:occurrence read as rtcDoc:occerrence"),
    (RTC_03, "rtcExt:saveProject", "rtc:saveProject", "D09", "rtc:saveProject read as rtcExt:saveProject"),
    (RTC_03, " rtcExt:saveProject", " saveproject", "D09", "saveproject read as rtcExt:saveProject"),
    (RTC_03, 'rtcExt:variableName="m_gain"', 'rtc:varname="m_gain"', "D09", "rtc:varname read as rtcExt:variableName"),
    (RTC_03, "<rtcExt:VersionUpLogs>first</rtcExt:VersionUpLogs>", "<rtcExt:VersionUpLog>first</rtcExt:VersionUpLog>", "D09", "read as rtcExt:VersionUpLogs"),
    (RTS_02, '<rts:WaitTime rts:waitTime="100"/>', "", "D10", "rts:WaitTime added"),
    (RTS_02, '    <rtsExt:Location rtsExt:x="1" rtsExt:y="2" rtsExt:height="-1" rtsExt:width="-1" rtsExt:direction="RIGHT"/>\n', "", "D10",
     "rtsExt:Location added"),
    (RTC_03, "</rtc:ConfigurationSet>", "</rtc:ConfigurationSet><rtc:ConfigurationSet/>", "D11", "ignored"),
    (RTC_03, "</rtc:ConfigurationSet>", "</rtc:ConfigurationSet>text", "D12", "ignored"),
    (RTS_01, "RTSystemProfile", "RtsProfile", "D13", "rts:RtsProfile renamed to rts:RTSystemProfile"),
    (RTC_03, 'rtc:version="0.3"', 'rtc:version="0.2"', "D14", "marked '0.2', read as 0.3"),
    (RTC_02, 'rtc:version="0.2"', 'rtc:version="1.0"', "D14", "marked '1.0', read as 0.2"),
    (RTC_02, ' rtc:version="0.2"', "", "D14", "marked '', read as 0.2"),
    (RTC_01, 'rtc:version="0.1"', 'rtc:version="0.3"', "D14", "marked '0.3', read as 0.1"),
    (RTC_03, '"2026-01-02T03:04:05Z"', '"2026/1/2 3:04"', "D15", "rtc:updateDate='2026/1/2 3:04' read as '2026-01-02T03:04:00'"),
    (RTC_03, '"2026-01-02T03:04:05Z"', '"2026-01-02T03:04:05+0900"', "D15",
     "rtc:updateDate='2026-01-02T03:04:05+0900' read as '2026-01-02T03:04:05+09:00'"),
    (RTC_03, '"2026-01-02T03:04:05Z"', '"today"', "D15", "rtc:updateDate='today' read as '1970-01-01T00:00:00'"),
])  # fmt: skip
def test_a_deviation_is_accepted_and_named(tmp_path: Path, sample: str, old: str, new: str, number: str, repair_: str) -> None:
    assert old in sample
    path = write(tmp_path, sample.replace("RTSystemProfile", "RtsProfile") if number == "D13" else sample.replace(old, new, 1))
    profile = load_profile(path, tolerant=True)

    assert load_profile(path).violations != []
    assert profile.violations == []
    assert (number, repair_) in [(deviation.id, deviation.repair) for deviation in profile.deviations]
    assert {deviation.id for deviation in profile.deviations} <= {number, *FOLLOWING.get(number, ())}
    assert all(deviation.line >= 1 and deviation.sentence == DEVIATIONS[deviation.id] for deviation in profile.deviations)


@pytest.mark.verifies("SWR-PFL-005", polarity="violation")
@pytest.mark.parametrize(("sample", "old", "new"), [
    (RTC_03, 'rtc:name="speed" rtc:portType="DataInPort"', 'rtc:portType="DataInPort"'),
    (RTC_03, 'rtc:portType="DataInPort" ', ""),
    (RTC_03, '"DataInPort"', '"DataPort"'),
    (RTC_03, 'rtc:type="RTC::TimedDouble"', ""),
    (RTC_03, 'rtc:id="RTC:Mamori:test:Motor:1.0.0"', ""),
    (RTC_03, 'rtc:direction="Provided"', ""),
    (RTC_03, 'rtc:direction="Provided"', 'rtc:direction="x"'),
    (RTC_03, '"PERIODIC"', '"PERIODICAL"'),
    (RTC_03, '<rtc:OnInitialize rtc:implemented="true"', "<rtc:OnInitialize"),
    (RTS_02, ' rts:dataType="IDL:RTC/TimedDouble:1.0"', ""),
    (RTS_02, ' rts:isRequired="true"', ""),
    (RTC_03, "<rtc:UpperBoundary>2</rtc:UpperBoundary>", ""),
    (RTS_02, 'rts:instanceName="Motor0"', ""),
    (RTS_02, 'rts:connectorId="c1"', ""),
    (RTS_02, 'rts:sequence="1"', 'rts:sequence="first"'),
    (RTS_02, "<rts:Members ", "<rts:Other "),
    (RTS_02, "  <rts:Groups", "  <rts:TargetComponent/><rts:Groups"),
])  # fmt: skip
def test_names_ports_and_directions_are_not_invented(tmp_path: Path, sample: str, old: str, new: str) -> None:
    assert old in sample

    assert load_profile(write(tmp_path, sample.replace(old, new, 1)), tolerant=True).violations != []


@pytest.mark.verifies("SWR-PFL-005")
@pytest.mark.parametrize("name", SAMPLES)
def test_a_valid_profile_has_no_deviation_and_is_not_changed(tmp_path: Path, name: str) -> None:
    profile = load_profile(write(tmp_path, SAMPLES[name]), tolerant=True)

    assert (profile.violations, profile.deviations) == ([], [])
    assert profile.version.replace(".", "_") == name[4:7]


@pytest.mark.verifies("SWR-PFL-005", technique="error_guessing")
def test_a_composite_type_of_another_version_has_no_meaning(tmp_path: Path) -> None:
    profile = load_profile(write(tmp_path, RTS_02.replace('rts:compositeType="None"', 'rts:compositeType="ECShared"')), tolerant=True)

    assert {(own.id, own.repair) for own in profile.deviations} == {("D06", "rts:compositeType='ECShared' ignored")}


@pytest.mark.verifies("SWR-PFL-005")
def test_a_type_of_a_connection_comes_from_its_port(tmp_path: Path) -> None:
    text = RTS_02.replace(' rts:dataType="IDL:RTC/TimedDouble:1.0"', "").replace(
        '<rts:DataPorts xsi:type="rtsExt:dataport_ext" rts:name="out" rtsExt:visible="true"/>',
        '<rts:DataPorts xsi:type="rtsExt:dataport_ext" rts:name="out"><rtsExt:Properties rtsExt:name="dataport.data_type" rtsExt:value="T"/></rts:DataPorts>',
    )
    profile = load_profile(write(tmp_path, text), tolerant=True)

    assert [deviation.repair for deviation in profile.deviations] == ["rts:dataType='T' added"]


@pytest.mark.verifies("SWR-PFL-005")
def test_prefixes_of_the_file_are_used_or_added(tmp_path: Path) -> None:
    spaces = RTC_SPACES.replace("xmlns:rtcExt", "xmlns:ext").replace('xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"', "")
    text = RTC_03.replace(RTC_SPACES, spaces).replace("rtcExt:", "ext:")
    for name in ("basic_info_ext", "configuration_ext", "dataport_ext", "serviceport_ext", "serviceinterface_ext", "language_ext"):
        text = text.replace(f' xsi:type="ext:{name}"', "")
    text = text.replace(' xsi:type="rtcDoc:action_status_doc"', "").replace(' xsi:type="rtcDoc:event_doc"', "")
    profile = load_profile(write(tmp_path, text), tolerant=True)

    assert profile.violations == []
    assert {deviation.id for deviation in profile.deviations} == {"D01"}


@pytest.mark.verifies("SWR-PFL-005", technique="boundary_values")
@pytest.mark.parametrize(("value", "type_", "is_valid", "meant"), [
    ("9" * 24, "integer", True, None), ("9" * 25, "integer", False, None), ("1e3", "integer", False, "1000"), ("1.5", "integer", False, None),
    (" 7 ", "integer", True, "7"), ("1e16", "integer", False, None), (".", "double", False, None), ("-INF", "double", True, None),
    (".5e-3", "double", True, None),
    ("2026-02-28T23:59:59", "dateTime", True, "2026-02-28T23:59:59"), ("2026-02-29T00:00:00", "dateTime", False, None),
    ("2026.12.31", "dateTime", False, "2026-12-31T00:00:00"), ("26-12-31", "dateTime", False, None), ("TRUE", "boolean", False, "true"),
    ("maybe", "boolean", False, None),
])  # fmt: skip
def test_limits_of_values(value: str, type_: str, is_valid: bool, meant: str | None) -> None:
    assert is_of_type(value, type_, ()) is is_valid
    assert find_meant(value, type_, ()) == meant


NOTED = [
    (RTC_03, "RTC:Mamori:test:Motor:1.0.0", "Motor", "N04", "Motor"),
    (RTC_03, 'rtc:name="event"', 'rtc:name="speed"', "N07", "speed"),
    (RTC_03, 'rtc:type="double"', 'rtc:type="unsigned int "', "N05", "rtc:type='unsigned int '"),
    (RTS_02, "left: 1", "IOR:0100", "N01", "rtsExt:value"),
    (RTS_02, 'rts:ConfigurationSets rts:id="default"', 'rts:ConfigurationSets rts:id="__widget__"', "N02", "__widget__"),
    (RTS_02, '"PERIODIC"', '"PeriodicExecutionContext"', "N03", "rts:kind='PeriodicExecutionContext'"),
    (RTS_02, "RTSystem:Mamori:Drive:1.0.0", "Drive", "N04", "Drive"),
    (RTC_03, 'rtc:version="0.3"', 'rtc:version="0.4"', "N08", "'0.4', read as 0.3"),
    (RTS_02, 'rts:portName="Motor0.in"', 'rts:portName="Motor0.inn"', "N06", "port Motor0.inn of Motor0"),
    (RTS_02, 'rts:id="RTC:Mamori:test:Motor:1.0.0"', 'rts:id="RTC:Mamori:test:Motor:2.0.0"', "N06", "component Motor0 (RTC:Mamori:test:Motor:1.0.0)"),
    (RTS_02, '<rts:DataPorts xsi:type="rtsExt:dataport_ext" rts:name="in"', '<rts:DataPorts xsi:type="rtsExt:dataport_ext" rts:name="out"', "N07", "out"),
]


@pytest.mark.verifies("SWR-PFL-009")
@pytest.mark.parametrize(("sample", "old", "new", "number", "detail"), NOTED)
def test_a_note_names_what_a_reader_should_know(tmp_path: Path, sample: str, old: str, new: str, number: str, detail: str) -> None:
    assert old in sample
    profile = load_profile(write(tmp_path, sample.replace(old, new, 1)))
    notes = list_notes(profile.root, profile.family, profile.table)

    assert profile.violations == []
    assert (number, detail) in [(note.id, note.repair) for note in notes]
    assert all(note.sentence == NOTES[note.id] for note in notes)


@pytest.mark.verifies("SWR-PFL-009")
@pytest.mark.parametrize("name", ["rtc_0_3.xml", "rtc_0_2.xml", "rtc_0_1.xml", "rts_0_2.xml"])
def test_a_usual_profile_has_no_note(tmp_path: Path, name: str) -> None:
    profile = load_profile(write(tmp_path, SAMPLES[name]))

    assert list_notes(profile.root, profile.family, profile.table) == []


@pytest.mark.verifies("SWR-PFL-009")
def test_two_components_of_one_name_are_noted(tmp_path: Path) -> None:
    component = RTS_02[RTS_02.index("  <rts:Components") : RTS_02.index("</rts:Components>") + 18]
    profile = load_profile(write(tmp_path, RTS_02.replace(component, component * 2, 1)))

    assert [(note.id, note.repair) for note in list_notes(profile.root, "rts", profile.table)] == [("N07", "Sensor0")]


@pytest.mark.skipif(not SHARED.is_dir(), reason=f"{SHARED} not found")
def test_public_files_are_loaded_with_named_deviations() -> None:
    found = {}
    for path in sorted([*SHARED.glob("rt[cs]/*"), *SHARED.glob("rtcconf/*")]):
        profile = load_profile(path, tolerant=True)
        assert profile.violations == [], path
        if profile.deviations:
            found[path.name + profile.version] = Counter(deviation.id for deviation in profile.deviations)
        else:
            assert load_profile(path).violations == []
    assert found == {
        "iso22166_sample_invalid.xml0.3": {"D05": 3}, "one_component_invalid.xml0.2": {"D01": 1},
        "raspberry_pi_example.xml0.2": {"D03": 2, "D04": 2}, "reference_0_1.xml0.1": {"D05": 5, "D13": 1},
        "rtsystem.xml0.2": {"D01": 1, "D03": 6, "D05": 3}, "sys.rtsys0.2": {"D01": 7}, "tank_system.xml0.2": {"D03": 3, "D04": 7},
        "fsm_observer_repeated_key.conf": {"D21": 2}, "rtc.conf.sample": {"D21": 15, "D22": 2},
    }  # fmt: skip


@pytest.mark.parametrize("name", ["rtc_0_3.xml", "rts_0_2.xml"])
def test_any_change_is_repaired_or_found_without_an_exception(tmp_path: Path, name: str) -> None:
    profile = load_profile(write(tmp_path, SAMPLES[name]))
    for seed in range(40):
        version = list_versions(profile.family)[seed % len(list_versions(profile.family))]
        root, _ = repair(mutate(profile.root, load_table(profile.family, version), seed), load_table(profile.family, version))
        again, found = repair(root, load_table(profile.family, version))

        assert again is root
        assert found == [], seed
