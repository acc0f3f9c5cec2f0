# SPDX-License-Identifier: Apache-2.0
# Goal: each of the 97 fields of RTCBuilder has its place. Method: one test per field with the value that a small own profile has there.
from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree
from profile_samples import RTC_01, RTC_02, RTC_03, RTC_SPACES

from mamori_tools.profiles.constraint_xml import format_constraint
from mamori_tools.profiles.fields import FIELDS, NO_NOTATION, read_fields
from mamori_tools.profiles.profile import load_profile

ONLY_REPEATED = (29, 34, 63, 71)
"""Fields that store nothing."""
VALUES = dict(zip((number for number in range(1, 98) if number not in ONLY_REPEATED), [
    "Motor", "a motor", "1.0.0", "Mamori", "test", "STATIC", "PERIODIC", "DataFlowComponent", "2", "PeriodicExecutionContext", "1000.0", "モータ", "t", "Motor",
    "true", "", "", "", "", "", "", "", "", "true", "", "", "", "", "moves", "p", "q",
    "speed", "RTC::TimedDouble", "in", "LEFT", "d", "t", "1", "s", "u", "o", "p",
    "service", "RIGHT", "d", "i",
    "reset", "Provided", "r", "m_reset", "Reset.idl", "Reset", "idl", "d", "a", "r", "e", "p", "q",
    "gain", "double", "1.5", "m_gain", "1", "0<=x<=2", "slider", "0.01", "n", "v", "d", "u", "r", "c",
    "rate", "5",
    "d", "i", "a", "c", "l", "r", "second", "first",
    "C++", "17", "Linux", "12", "x86-64", "o", "c", "Eigen", "3", "i",
], strict=True))  # fmt: skip


def read(folder: Path, text: str) -> dict[int, list[str]]:
    path = folder / "RTC.xml"
    path.write_text(text, encoding="utf-8")
    profile = load_profile(path)
    assert profile.violations == []
    found: dict[int, list[str]] = {}
    for own in read_fields(profile.root, profile.table):
        found.setdefault(own.field.number, []).append(own.value)
    return found


@pytest.mark.verifies("SWR-PFL-008")
@pytest.mark.parametrize("number", range(1, 98))
def test_a_field_has_its_place(tmp_path: Path, number: int) -> None:
    field = FIELDS[number - 1]
    found = read(tmp_path, RTC_02).get(number, [""])

    assert (field.number, bool(field.place)) == (number, number not in ONLY_REPEATED)
    assert found[0] == VALUES.get(number, "")


@pytest.mark.verifies("SWR-PFL-008")
def test_the_forms_have_97_fields_in_8_tables() -> None:
    counts = {table: sum(field.table == table for field in FIELDS) for table in sorted({field.table for field in FIELDS})}

    assert counts == {5: 14, 6: 18, 7: 12, 8: 4, 9: 13, 10: 18, 12: 8, 13: 10}
    assert sum(field.is_required for field in FIELDS) == 25


@pytest.mark.verifies("SWR-PFL-008")
def test_old_spellings_have_the_same_fields(tmp_path: Path) -> None:
    found = read(tmp_path, RTC_01)

    assert (found[36], found[37], found[86], found[88], found[95]) == (["in"], ["left"], ["first"], ["Java"], ["x.jar"])


UNIT = "<rtc:Constraint><rtc:ConstraintUnitType{}>{}</rtc:ConstraintUnitType></rtc:Constraint>"


def make(content: str, key: str = "") -> str:
    return UNIT.format(f' rtc:key="{key}"' if key else "", content)


def compare_with(name: str, value: str) -> str:
    return f'<rtc:{name} rtc:matchCase="false"><rtc:Literal>{value}</rtc:Literal></rtc:{name}>'


ABOVE, BELOW = make(compare_with("propertyIsGreaterThan", "1")), make(compare_with("propertyIsLessThanOrEqualTo", "2"))
EQUAL = [make(compare_with("propertyIsEqualTo", value)) for value in "ab"]


@pytest.mark.verifies("SWR-PFL-008", technique="equivalence_classes")
@pytest.mark.parametrize(("xml", "text"), [
    (make(compare_with("propertyIsEqualTo", "100")), "100"), (make(compare_with("propertyIsGreaterThanOrEqualTo", "1")), "x>=1"), (ABOVE, "x>1"),
    (make(compare_with("propertyIsLessThan", "1")), "x<1"), (BELOW, "x<=2"),
    (make("<rtc:propertyIsBetween><rtc:LowerBoundary>1</rtc:LowerBoundary><rtc:UpperBoundary>2</rtc:UpperBoundary></rtc:propertyIsBetween>"), "1<=x<=2"),
    (make(f"<rtc:And>{ABOVE}{BELOW}</rtc:And>"), "1<x<=2"), (make(f"<rtc:Or>{''.join(EQUAL)}</rtc:Or>"), "(a,b)"),
    (f"<rtc:Constraint><rtc:ConstraintListType>{ABOVE}{BELOW}</rtc:ConstraintListType></rtc:Constraint>", "x>1,x<=2"),
    (f"<rtc:Constraint><rtc:ConstraintHashType>{make(compare_with('propertyIsEqualTo', '1'), 'k')}</rtc:ConstraintHashType></rtc:Constraint>", "{k:1}"),
    (f"<rtc:Constraint><rtc:ConstraintHashType>{ABOVE}</rtc:ConstraintHashType></rtc:Constraint>", None),
    (make(f"<rtc:Not>{ABOVE}</rtc:Not>"), None), (make(f"<rtc:And>{BELOW}{ABOVE}</rtc:And>"), "1<x<=2"),
    (make(f"<rtc:And>{BELOW}{BELOW}</rtc:And>"), None), (make(f"<rtc:Or>{ABOVE}{EQUAL[0]}</rtc:Or>"), None),
    (f"<rtc:Constraint><rtc:ConstraintListType>{make(f'<rtc:Not>{ABOVE}</rtc:Not>')}</rtc:ConstraintListType></rtc:Constraint>", None),
])  # fmt: skip
def test_a_constraint_is_shown_in_the_notation(xml: str, text: str | None) -> None:
    assert format_constraint(etree.fromstring(xml.replace("<rtc:Constraint>", f"<rtc:Constraint {RTC_SPACES}>", 1))) == text


@pytest.mark.verifies("SWR-PFL-008")
def test_a_constraint_without_notation_is_marked(tmp_path: Path) -> None:
    old = RTC_03[RTC_03.index("<rtc:Constraint>") : RTC_03.index("</rtc:Constraint>") + 17]

    assert read(tmp_path, RTC_03.replace(old, make(f"<rtc:Not>{ABOVE}</rtc:Not>")))[68] == [NO_NOTATION]
