# SPDX-License-Identifier: Apache-2.0
"""The notation of a constraint from its XML form, `rtc:Constraint`.

@satisfies SWR-PFL-008      Design: docs/design/profiles.md#fields
Source: the 11 forms of the reference parser of RTCBuilder
"""

from __future__ import annotations

from lxml import etree

from mamori_tools.profiles.xml_file import get_local_name

COMPARISONS = {"propertyIsLessThan": "x<{}", "propertyIsGreaterThan": "x>{}", "propertyIsLessThanOrEqualTo": "x<={}",
               "propertyIsGreaterThanOrEqualTo": "x>={}", "propertyIsEqualTo": "{}"}  # fmt: skip
LOWER = {"propertyIsGreaterThan": "<", "propertyIsGreaterThanOrEqualTo": "<="}
UPPER = {"propertyIsLessThan": "<", "propertyIsLessThanOrEqualTo": "<="}


def format_constraint(element: etree._Element) -> str | None:
    """@param element `rtc:Constraint`. @return None for a constraint that the notation cannot express."""
    [content] = element.iterchildren("*")
    match get_local_name(content):
        case "ConstraintListType":
            parts = [format_constraint(item) for item in content.iterchildren("*")]
            return None if None in parts else ",".join(filter(None, parts))
        case "ConstraintHashType":
            parts = [_format_entry(item) for item in content.iterchildren("*")]
            return None if None in parts else "{" + ",".join(filter(None, parts)) + "}"
        case _:
            return _format_unit(content)


def _format_entry(item: etree._Element) -> str | None:
    [content] = item.iterchildren("*")
    key = next((value for name, value in content.attrib.items() if name.endswith("}key")), None)
    text = format_constraint(item)
    return None if key is None or text is None else f"{key}:{text}"


def _format_unit(unit: etree._Element) -> str | None:
    [rule] = unit.iterchildren("*")
    name = get_local_name(rule)
    if name in COMPARISONS:
        return COMPARISONS[name].format(_get_literal(rule))
    if name == "propertyIsBetween":
        lower, upper = (child.text or "" for child in rule.iterchildren("*"))
        return f"{lower}<=x<={upper}"
    rules = [list(part.iterchildren("*")) for part in rule.iterfind("{*}Constraint/{*}ConstraintUnitType")]
    parts = [part[0] for part in rules if part]
    names = [get_local_name(part) for part in parts]
    if name == "Or" and len(parts) == len(rule) and set(names) == {"propertyIsEqualTo"}:
        return f"({','.join(map(_get_literal, parts))})"
    if len(names) == 2 and names[0] in UPPER:
        parts, names = parts[::-1], names[::-1]
    if name == "And" and len(parts) == len(rule) == 2 and names[0] in LOWER and names[1] in UPPER:
        return f"{_get_literal(parts[0])}{LOWER[names[0]]}x{UPPER[names[1]]}{_get_literal(parts[1])}"
    return None


def _get_literal(rule: etree._Element) -> str:
    return next((child.text or "" for child in rule.iterchildren("*")), "")
