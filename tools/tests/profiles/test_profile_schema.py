# SPDX-License-Identifier: Apache-2.0
# Goal: the strict verdict is that of the published schemas. Method: edits of small own profiles with known verdict; with the public files next to
# the project, seeded changes of them against the published schemas, which the same library checks.
from __future__ import annotations

from pathlib import Path

import pytest
from profile_mutations import mutate
from profile_samples import RTC_01, RTC_02, RTC_03, RTS_01, RTS_02, SAMPLES

from mamori_tools.profiles.profile import load_profile
from mamori_tools.profiles.schema_check import find_violations
from mamori_tools.profiles.schema_table import list_versions, load_table
from mamori_tools.profiles.xml_file import parse_xml
from mamori_trace.base.errors import InputError

SHARED = Path(__file__).resolve().parents[3] / "../shared/data/profiles"


def write(folder: Path, text: str, name: str = "profile.xml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.verifies("SWR-PFL-002")
@pytest.mark.parametrize("name", SAMPLES)
def test_a_profile_with_each_kind_of_element_is_valid(tmp_path: Path, name: str) -> None:
    profile = load_profile(write(tmp_path, SAMPLES[name]))

    assert profile.violations == []
    assert (profile.family, profile.version.replace(".", "_")) == (name[:3], name[4:7])


@pytest.mark.verifies("SWR-PFL-002", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(("sample", "old", "new", "place"), [
    (RTC_03, ' rtc:vendor="Mamori"', "", "BasicInfo"),
    (RTC_03, 'activityType="PERIODIC"', 'activityType="PERIODOC"', "BasicInfo"),
    (RTC_03, '"Provided"', '"PROVIDED"', "ServicePorts[service]/ServiceInterface[reset]"),
    (RTC_03, 'maxInstances="2"', 'maxInstances="2.5"', "BasicInfo"),
    (RTC_03, 'executionRate="1000.0"', 'executionRate="fast"', "BasicInfo"),
    (RTC_03, 'updateDate="2026-01-02T03:04:05Z"', 'updateDate="2026-02-30T03:04:05Z"', "BasicInfo"),
    (RTC_03, 'implemented="true"/>', 'implemented="yes"/>', "Actions/OnInitialize"),
    (RTC_03, ' xsi:type="rtcExt:dataport_ext" rtc:name="speed"', ' rtc:name="speed"', "DataPorts[speed]"),
    (RTC_03, '"rtcExt:configuration_ext"', '"rtcExt:dataport_ext"', "ConfigurationSet/Configuration[gain]"),
    (RTC_03, "<rtc:UpperBoundary>2</rtc:UpperBoundary>", "",
     "ConfigurationSet/Configuration[gain]/Constraint/ConstraintUnitType/propertyIsBetween"),
    (RTC_03, "</rtc:ConfigurationSet>", "</rtc:ConfigurationSet>text", "rtc:RtcProfile"),
    (RTC_03, 'rtc:idlFile="Reset.idl"', 'rtc:idlFile="Reset.idl" rtc:path="idl"', "ServicePorts[service]/ServiceInterface[reset]"),
    (RTC_02, "DataOutPort", "EventPort", "DataPorts[event]"),
    (RTC_01, "subscriprionType", "subscriptionType", "DataPorts[speed]"),
    (RTC_01, '<rtc:OnReset rtc:implemented="false"/>', "", "Actions/OnExecute"),
    (RTC_01, 'position="left"', 'position="LEFT"', "DataPorts[speed]"),
    (RTS_02, '<rts:WaitTime rts:waitTime="100"/>', "", "StartUp/targets[1]/TargetComponent"),
    (RTS_02, 'rtsExt:direction="RIGHT"', 'rtsExt:direction="right"', "Components[Sensor0]/Location"),
    (RTS_02, 'rts:dataType="IDL:RTC/TimedDouble:1.0"', "", "DataPortConnectors[line]"),
    (RTS_01, "AllShared", "PeriodicECShared", "Component[Motor0]"),
    (RTS_01, "PT1S", "1", "Component[Motor0]/StartUp[1]/Condition/WaitTime"),
])  # fmt: skip
def test_a_violation_is_found_at_its_place(tmp_path: Path, sample: str, old: str, new: str, place: str) -> None:
    assert old in sample
    violations = load_profile(write(tmp_path, sample.replace(old, new, 1))).violations

    assert violations[0].place == place
    assert violations[0].line > 1
    assert "http" not in violations[0].text


@pytest.mark.verifies("SWR-PFL-002", technique="boundary_values")
@pytest.mark.parametrize(("count", "is_valid"), [(1, False), (2, True), (3, True)])
def test_an_and_has_at_least_two_constraints(tmp_path: Path, count: int, is_valid: bool) -> None:
    rule = "<rtc:propertyIsNullType><rtc:propertyIsNull/></rtc:propertyIsNullType>"
    part = f"<rtc:Constraint><rtc:ConstraintUnitType>{rule}</rtc:ConstraintUnitType></rtc:Constraint>"
    old = RTC_03[RTC_03.index("<rtc:propertyIsBetween>") : RTC_03.index("</rtc:ConstraintUnitType>")]

    assert (load_profile(write(tmp_path, RTC_03.replace(old, f"<rtc:And>{part * count}</rtc:And>"))).violations == []) is is_valid


@pytest.mark.verifies("SWR-PFL-003")
def test_schema_files_of_the_user_replace_the_tables(tmp_path: Path) -> None:
    space = "http://www.openrtp.org/namespaces/rtc"
    write(tmp_path, f'<xsd:schema xmlns:xsd="http://www.w3.org/2001/XMLSchema" targetNamespace="{space}"><xsd:include schemaLocation="RtcProfile_part.xsd"/>'
          "</xsd:schema>", "RtcProfile_ext.xsd")  # fmt: skip
    write(tmp_path, f'<xsd:schema xmlns:xsd="http://www.w3.org/2001/XMLSchema" targetNamespace="{space}"><xsd:element name="RtcProfile" type="xsd:string"/>'
          "</xsd:schema>", "RtcProfile_part.xsd")  # fmt: skip
    own = write(tmp_path, f'<r:RtcProfile xmlns:r="{space}">text</r:RtcProfile>')

    assert load_profile(own, schema=tmp_path).violations == []
    assert load_profile(own).violations != []
    assert load_profile(write(tmp_path, RTC_03), schema=tmp_path).violations != []


@pytest.mark.verifies("SWR-PFL-003", polarity="violation")
@pytest.mark.parametrize(("content", "message"), [(None, "has no RtcProfile_ext.xsd"), ("<cut", "not a usable schema"), ("<a/>", "not a usable schema")])
def test_a_folder_without_usable_schema_is_rejected(tmp_path: Path, content: str | None, message: str) -> None:
    folder = tmp_path / "schema"
    folder.mkdir()
    if content is not None:
        write(folder, content, "RtcProfile_ext.xsd")

    with pytest.raises(InputError, match=message):
        load_profile(write(tmp_path, RTC_03), schema=folder)


@pytest.mark.verifies("SWR-PFL-003")
def test_the_schema_set_of_the_version_is_used(tmp_path: Path) -> None:
    schema = '<xsd:schema xmlns:xsd="http://www.w3.org/2001/XMLSchema" targetNamespace="http://www.openrtp.org/namespaces/rtc"><!--{}-->{}</xsd:schema>'
    valid, invalid = '<xsd:element name="RtcProfile"/>', '<xsd:element name="Other"/>'
    for name, mark, basic in (("new/", "EventPort", invalid), ("new/V2", "", invalid), ("old/", "", valid), ("old/V1", "subscriprionType", valid)):
        (tmp_path / name[:3]).mkdir(exist_ok=True)
        write(tmp_path, schema.format(mark, basic), f"{name}RtcProfile_basic.xsd")
    for name in ("new/", "old/", "old/V1"):
        write(tmp_path, schema.format("", '<xsd:include schemaLocation="RtcProfile_basic.xsd"/>'), f"{name}RtcProfile_ext.xsd")

    texts = [f'<r:RtcProfile xmlns:r="http://www.openrtp.org/namespaces/rtc" r:version="{version}"/>' for version in list_versions("rtc")]
    verdicts = [load_profile(write(tmp_path, text), schema=tmp_path).violations == [] for text in texts]
    assert verdicts == [True, True, False]
    with pytest.raises(InputError, match=r"old: has no RtcProfile_ext\.xsd of version 0\.3"):
        load_profile(write(tmp_path, RTC_03), schema=tmp_path / "old")


@pytest.mark.skipif(not SHARED.is_dir(), reason=f"{SHARED} not found")
@pytest.mark.parametrize("seeds", [range(8), pytest.param(range(8, 110), marks=pytest.mark.long)])
def test_public_and_changed_profiles_have_the_verdict_of_the_published_schemas(seeds: range) -> None:
    verdicts = {True: 0, False: 0}
    for path in sorted([*SHARED.glob("rtc/*.xml"), *SHARED.glob("rts/*.xml"), *SHARED.glob("rts/*.rtsys")]):
        profile = load_profile(path)
        assert profile.violations == load_profile(path, schema=SHARED / "schema").violations, path
        for seed in seeds:
            version = list_versions(profile.family)[seed % len(list_versions(profile.family))]
            root = mutate(profile.root, load_table(profile.family, version), seed)
            own = find_violations(root, profile.family, version)
            published = find_violations(root, profile.family, version, SHARED / "schema")

            assert bool(own) == bool(published), (path, version, seed, own or published)
            verdicts[not own] += 1
    assert min(verdicts.values()) > 10


def test_a_change_of_a_tree_does_not_change_the_original(tmp_path: Path) -> None:
    root = parse_xml(RTC_03.encode(), tmp_path / "x").getroot()
    mutate(root, load_table("rtc", "0.3"), 3)

    assert find_violations(root, "rtc", "0.3") == []
