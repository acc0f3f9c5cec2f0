# SPDX-License-Identifier: Apache-2.0
# Goal: an RTS profile and its YAML form have the same content, in both directions and in any spelling of the values.
from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from profile_mutations import mutate
from profile_samples import RTC_03, RTS_01, RTS_02

from mamori_tools.profiles.compare import compare, flatten
from mamori_tools.profiles.convert import convert, make_portable
from mamori_tools.profiles.profile import Profile, load_profile
from mamori_tools.profiles.repair import repair
from mamori_tools.profiles.schema_check import find_violations
from mamori_tools.profiles.schema_table import load_table
from mamori_tools.profiles.xml_file import canonicalize, parse_xml
from mamori_tools.profiles.yaml_twin import format_yaml, parse_yaml
from mamori_trace.base.errors import InputError

SHARED = Path(__file__).resolve().parents[3] / "../shared/data/profiles/rts"
TABLE = load_table("rts", "0.2")


def write(folder: Path, text: str, name: str = "system.xml") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def turn(profile: Profile) -> Profile:
    """To YAML and back."""
    root, unknown = parse_yaml(format_yaml(profile.root, TABLE).encode(), profile.path, TABLE)
    assert unknown == []
    return Profile(profile.path, b"", "rts", "yaml", "0.2", root)


def canonicalize_content(root: Any, path: Path) -> bytes:
    """Canonical XML without layout."""
    tree = parse_xml(canonicalize(root.getroottree()), path)
    for node in tree.getroot().iter("*"):
        node.text, node.tail = (text if text and text.strip() else None for text in (node.text, node.tail))
    return canonicalize(tree)


@pytest.mark.verifies("SWR-PFL-006", technique="back_to_back")
def test_there_and_back_is_the_same_canonical_xml(tmp_path: Path) -> None:
    profile = load_profile(write(tmp_path, RTS_02))

    assert canonicalize_content(turn(profile).root, profile.path) == canonicalize_content(profile.root, profile.path)


@pytest.mark.verifies("SWR-PFL-006", technique="back_to_back")
def test_seeded_changes_go_there_and_back(tmp_path: Path) -> None:
    profile = load_profile(write(tmp_path, RTS_02))
    compared = 0
    for seed in range(60):
        root, _ = repair(mutate(profile.root, TABLE, seed), TABLE)
        if not find_violations(root, "rts", "0.2"):
            changed = Profile(profile.path, b"", "rts", "xml", "0.2", root)
            assert canonicalize_content(turn(changed).root, profile.path) == canonicalize_content(root, profile.path), seed
            compared += 1
    assert compared > 20


@pytest.mark.verifies("SWR-PFL-006")
def test_keys_dates_and_types_are_those_of_the_yaml_form(tmp_path: Path) -> None:
    text = format_yaml(load_profile(write(tmp_path, RTS_02)).root, TABLE)
    system = yaml.safe_load(text)["rtsProfile"]
    component = system["components"][0]

    assert '"rtsExt::comment": c' in text
    assert system["updateDate"] == {"year": 2026, "month": 1, "day": 2, "hour": 3, "minute": 4, "second": 5}
    assert system["creationDate"] == {**system["updateDate"], "fraction": ".250", "zone": "+09:00"}
    assert (component["isRequired"], component["rtsExt::visible"], component["executionContexts"][0]["rate"]) == (True, True, 1000.0)
    assert component["rtsExt::location"] == {"x": 1, "y": 2, "height": -1, "width": -1, "direction": "RIGHT"}
    assert component["rtsExt::properties"] == [{"name": "place", "value": "left: 1"}]
    assert component["configurationSets"][0]["configurationData"] == [{"name": "gain", "data": "1.50"}]
    assert system["startUp"]["targets"][0]["condition"] == {"waitTime": {"waitTime": 100}}
    assert system["startUp"]["targets"][1]["condition"]["preceding"]["precedingComponents"][0]["instanceName"] == "Motor0"
    assert system["startUp"]["targets"][1]["xsi::type"] == ""
    assert system["rtsExt::versionUpLogs"] == ["first: 1"]
    assert system["version"] == "0.2"


YAML = """\
rtsProfile:
    id: RTSystem:Mamori:Drive:1.0.0
    version: 0.2
    creationDate: {day: 6, hour: 13, minute: 49, month: 5, second: 53, year: 2008}
    updateDate: {day: 6, hour: 13, minute: 49, month: 5, second: 53, year: 2008}
    components:
    -   id: "RTC:Mamori:test:Motor:1.0.0"
        pathUri: a
        instanceName: Motor0
        isRequired: Yes
        compositeType: None
        activeConfigurationSet: null
        dataPorts: [{name: in, "rtsExt::visible": false}]
        executionContexts: [{id: 0, kind: PERIODIC, rate: 1e3}]
"""


@pytest.mark.verifies("SWR-PFL-006")
def test_values_keep_their_spelling_and_booleans_become_those_of_xml(tmp_path: Path) -> None:
    profile = load_profile(write(tmp_path, YAML, "system.yaml"))
    values = flatten(profile)

    assert profile.violations == []
    assert values["Components[Motor0]/ExecutionContexts[0]/@rate"] == "1e3"
    assert values["Components[Motor0]/@isRequired"] == "true"
    assert values["Components[Motor0]/DataPorts[in]/@visible"] == "false"
    assert values["@version"] == "0.2"
    assert "Components[Motor0]/@activeConfigurationSet" not in values
    assert compare(profile, turn(profile)) == []


@pytest.mark.verifies("SWR-PFL-006", polarity="violation")
@pytest.mark.parametrize(("old", "new", "line", "text"), [
    ("pathUri: a", "pathURI: a", 8, "the key is unknown"),
    ("name: in,", "name: in, colour: red,", 13, "the key is unknown"),
    ("pathUri: a", "pathUri: a\n        condition: {}", 9, "the key is unknown"),
    ("isRequired: Yes", "isRequired: maybe", 7, "'maybe' is not a valid value"),
    ("updateDate: {day: 6,", "updateDate: {days: 1, day: 6,", 5, "the key is unknown"),
    ("pathUri: a", "pathUri: a\n        xsi::type: rtsExt:nothing", 9, "xsi:type is not a type of this element"),
    ("pathUri: a", "pathUri: a\n        xsi::type: rts:dataport", 9, "xsi:type is not a type of this element"),
    ("compositeType: None", "compositeType: All", 7, "'All' is not an element of the set"),
])  # fmt: skip
def test_a_violation_has_the_line_of_the_yaml_file(tmp_path: Path, old: str, new: str, line: int, text: str) -> None:
    path = write(tmp_path, YAML.replace(old, new), "system.yml")
    violations = load_profile(path).violations

    assert any((violation.line, text in violation.text) == (line, True) for violation in violations), violations
    assert any(deviation.id in ("D02", "D20", "D05", "D06", "D04") for deviation in load_profile(path, tolerant=True).deviations) or "isRequired" in new


@pytest.mark.verifies("SWR-PFL-006", polarity="violation")
@pytest.mark.parametrize(("old", "new", "line", "text"), [
    ("dataPorts: [{name: in,", "dataPorts: [{name: [in],", 13, "a single value is expected"),
    ("dataPorts: [{name: in,", "dataPorts: [{[a]: in,", 13, "a key is not text"),
    ("pathUri: a", 'pathUri: "\\x01"', 8, "a control character"),
    ("creationDate: {day: 6,", "creationDate: {day: 0_6,", 4, "a date is a map of integers"),
    ("rtsProfile:", "other:", 1, "not the YAML form of an RTS profile"),
])  # fmt: skip
def test_a_file_that_is_not_the_yaml_form_is_rejected(tmp_path: Path, old: str, new: str, line: int, text: str) -> None:
    with pytest.raises(InputError, match=text) as caught:
        load_profile(write(tmp_path, YAML.replace(old, new), "system.yaml"))
    assert caught.value.line == line


@pytest.mark.verifies("SWR-PFL-006", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("levels", "message"), [(30, "a single value is expected"), (31, "nested deeper than 32 levels")])
def test_depth_is_limited(tmp_path: Path, levels: int, message: str) -> None:
    with pytest.raises(InputError, match=message):
        load_profile(write(tmp_path, f"rtsProfile:\n  id: {'[' * levels}{']' * levels}\n", "system.yaml"))


@pytest.mark.verifies("SWR-PFL-010")
def test_the_portable_form_has_plain_dates_extension_types_and_composite_types(tmp_path: Path) -> None:
    text = RTS_02.replace('xsi:type="rtsExt:condition_ext" ', "").replace(' rts:compositeType="None"', "")
    profile = load_profile(write(tmp_path, text))
    assert profile.violations == []

    lost = make_portable(profile)

    assert lost == ["rts:creationDate: .250+09:00"]
    assert find_violations(profile.root, "rts", "0.2") == []
    values = flatten(profile)
    assert (values["@creationDate"], values["Components[Motor0]/@compositeType"]) == ("2026-01-02T03:04:05", "None")
    assert format_yaml(profile.root, TABLE).count("xsi::type") == 0


@pytest.mark.verifies("SWR-PFL-010", polarity="violation")
@pytest.mark.parametrize(("text", "name", "message"), [
    (RTC_03, "out.yaml", "an RTC profile 0.3 has no YAML form"), (RTS_01, "out.yml", "an RTS profile 0.1 has no YAML form"),
    (RTS_02, "out.conf", "not an rtc.conf"),
])  # fmt: skip
def test_a_form_that_a_profile_does_not_have_is_rejected(tmp_path: Path, text: str, name: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        convert(load_profile(write(tmp_path, text)), tmp_path / name)


@pytest.mark.verifies("SWR-PFL-010", polarity="violation")
def test_rtc_conf_has_no_other_form_and_only_systems_a_portable_one(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"rtc\.conf has no other form"):
        convert(load_profile(write(tmp_path, "a: 1\n", "rtc.conf")), tmp_path / "out.xml")
    with pytest.raises(InputError, match="--portable is for RTS profiles"):
        make_portable(load_profile(write(tmp_path, RTC_03)))


@pytest.mark.verifies("SWR-PFL-006", technique="error_guessing")
def test_line_ends_of_unicode_are_kept(tmp_path: Path) -> None:
    profile = load_profile(write(tmp_path, RTS_02.replace("left: 1", "a\x85b\u2028c\u2029d")))

    assert compare(profile, turn(profile)) == []


@pytest.mark.verifies("SWR-PFL-010")
def test_comments_that_yaml_does_not_keep_are_counted(tmp_path: Path) -> None:
    _, losses = convert(load_profile(write(tmp_path, RTS_02.replace("  <rts:Groups", "  <!-- a --><rts:Groups"))), tmp_path / "out.yaml")

    assert losses == ["1 comments"]


@pytest.mark.skipif(not SHARED.is_dir(), reason=f"{SHARED} not found")
def test_public_systems_go_there_and_back() -> None:
    for path in sorted(SHARED.iterdir()):
        profile = load_profile(path, tolerant=True)
        if profile.version == "0.2":
            assert canonicalize_content(turn(profile).root, path) == canonicalize_content(profile.root, path), path
