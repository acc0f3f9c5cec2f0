# SPDX-License-Identifier: Apache-2.0
"""Writes a profile in another form.

@satisfies SWR-PFL-006, SWR-PFL-010      Design: docs/design/profiles.md#yaml-form
"""

from __future__ import annotations

from pathlib import Path

from lxml import etree

from mamori_tools.profiles.attribute_value import DATE
from mamori_tools.profiles.profile import Profile, parse_profile
from mamori_tools.profiles.schema_table import XSI_TYPE
from mamori_tools.profiles.view import RtsView
from mamori_tools.profiles.xml_file import canonicalize, format_xml, parse_xml
from mamori_tools.profiles.yaml_twin import expect_type, format_yaml, list_losses, list_names
from mamori_trace.base.errors import InputError

YAML = (".yaml", ".yml")
XML = (".xml", ".rtsys")


def convert(profile: Profile, target: Path) -> tuple[bytes, list[str]]:
    """@param profile a valid or repaired profile. @return the content of `target`, whose suffix gives the form, and what it does not keep.
    @raise InputError for a form that the profile does not have, or a result that would not be valid."""
    suffix = target.suffix.lower()
    if suffix not in (*XML, *YAML, ".conf"):
        raise InputError("the suffix names no form; specify a file .xml, .yaml or .conf", target)
    if profile.conf is not None:
        if suffix != ".conf":
            raise InputError("rtc.conf has no other form; specify a file .conf", target)
        return profile.conf.format(), []
    if suffix in YAML:
        if profile.family != "rts" or profile.version == "0.1":
            raise InputError(f"an {profile.title} has no YAML form; specify a file .xml", target)
        return _check_result(format_yaml(profile.root, profile.table).encode(), target), list_losses(profile.root)
    if suffix == ".conf":
        raise InputError(f"an {profile.title} is not an rtc.conf; specify a file .xml", target)
    tree = profile.root.getroottree()
    is_same = profile.form == "xml" and canonicalize(parse_xml(profile.data, profile.path)) == canonicalize(tree)
    return profile.data if is_same else _check_result(format_xml(tree), target), []


def _check_result(content: bytes, target: Path) -> bytes:
    """@return the content. A version that only the file names, for example in YAML, can make it invalid as XML."""
    violations = parse_profile(content, target).violations
    if violations:
        raise InputError(f"would be invalid: {violations[0].place}: {violations[0].text}; add --tolerant", target)
    return content


def make_portable(profile: Profile) -> list[str]:
    """Changes an RTS profile 0.2 so that rtsprofile also reads it: dates without fraction and zone, extension types, a composite type for each
    component. @return what the change loses."""
    if profile.family != "rts" or profile.version == "0.1":
        raise InputError("profile convert: --portable is for RTS profiles of version 0.2", profile.path)
    table, lost = profile.table, []
    uri = table.namespaces["rts"]
    for element in profile.root.iter("*"):
        for name, value in element.attrib.items():
            match = DATE.fullmatch(value) if name.endswith("Date") else None
            if match and (match[7] or match[8]):
                element.set(name, value[:19])
                lost.append(f"{table.shorten(name)}: {value[19:]}")
    for component in RtsView(profile.root, table).components:
        if not component.get_value("compositeType"):
            component.element.set(f"{{{uri}}}compositeType", "None")
    _add_types(profile.root, table.root_type, profile)
    return lost


def _add_types(element: etree._Element, declared: str, profile: Profile) -> None:
    table = profile.table
    if declared not in table.types:
        return
    expected = expect_type(declared, table, list_names(element))
    if XSI_TYPE not in element.attrib and expected != declared:
        prefix, _, local = expected.partition(":")
        used = next((name for name, uri in element.nsmap.items() if uri == table.namespaces[prefix]), None)
        if used is not None:
            element.set(XSI_TYPE, f"{used}:{local}")
    children = table.types[expected].children
    for child in element.iterchildren("*"):
        if child.tag in children:
            _add_types(child, children[child.tag].type, profile)
