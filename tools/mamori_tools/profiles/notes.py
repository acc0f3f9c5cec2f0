# SPDX-License-Identifier: Apache-2.0
"""What the schema accepts and a reader should know: names that do not exist, duplicate names, old names, private data.

@satisfies SWR-PFL-009      Design: docs/design/profiles.md#tolerant-mode
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from lxml import etree

from mamori_tools.profiles.deviation import Deviation
from mamori_tools.profiles.schema_table import SchemaTable
from mamori_tools.profiles.view import RtcView, RtsView, View
from mamori_tools.profiles.xml_file import describe_path

RTC_ID = re.compile(r"RTC(:[^:]+){4}")
OLD_RTC_ID = re.compile(r"RTC:.+\..+\..+:[^:]+")
RTS_ID = re.compile(r"RTSystem:[^:]+(:[^:]+){1,2}")
OLD_NAMES = {"kind": ("PeriodicExecutionContext",), "interfaceType": ("CORBA_Any", "CorbaPort"), "dataflowType": ("PUSH", "PULL", "Push", "Pull"),
             "subscriptionType": ("Flush", "New", "Periodic", "FLUSH", "NEW", "PERIODIC")}  # fmt: skip


def list_notes(root: etree._Element, family: str, table: SchemaTable) -> list[Deviation]:
    """@param root a valid or repaired tree. @return notes in the order of the file."""
    found = [*_check_values(root, table)]
    marked = View(root, table).get_value("version")
    if marked != table.version:
        found.append(_note("N08", View(root, table), f"{marked!r}, read as {table.version}"))
    found += _check_rtc(RtcView(root, table)) if family == "rtc" else _check_rts(RtsView(root, table))
    return sorted(found, key=lambda note: note.line)


def _note(number: str, view: View, text: str) -> Deviation:
    return Deviation(number, view.line, describe_path(view.element, view.table), text)


def _check_values(root: etree._Element, table: SchemaTable) -> Iterator[Deviation]:
    for element in root.iter("*"):
        view = View(element, table)
        for name, value in element.attrib.items():
            local = name.rpartition("}")[2]
            if local in ("type", "name", "id", "instanceName", "portName", "componentId") and value != value.strip():
                yield _note("N05", view, f"{table.shorten(name)}={value!r}")
            if value in OLD_NAMES.get(local, ()):
                yield _note("N03", view, f"{table.shorten(name)}={value!r}")
            if value.startswith("IOR:"):
                yield _note("N01", view, table.shorten(name))


def _check_rtc(profile: RtcView) -> Iterator[Deviation]:
    pattern = OLD_RTC_ID if profile.table.version == "0.1" else RTC_ID
    if not pattern.fullmatch(profile.get_value("id")):
        yield _note("N04", profile, profile.get_value("id"))
    yield from _find_duplicates([*profile.data_ports, *profile.service_ports], "name")
    yield from _find_duplicates(profile.configurations, "name")


def _check_rts(profile: RtsView) -> Iterator[Deviation]:
    if not RTS_ID.fullmatch(profile.get_value("id")):
        yield _note("N04", profile, profile.get_value("id"))
    for component in profile.components:
        for part in component.list_parts("ConfigurationSets"):
            if re.fullmatch("__.*__", part.get_value("id")):
                yield _note("N02", part, part.get_value("id"))
        yield from _find_duplicates(component.list_parts("DataPorts", "ServicePorts"), "name")
    yield from find_reference_errors(profile)


def find_reference_errors(profile: RtsView) -> Iterator[Deviation]:
    """Duplicate instances, and connections and orders with an unknown component or port. For the generation of a system, each is an error."""
    yield from _find_duplicates(profile.components, "instanceName", "id")
    known = {(part.get_value("id"), part.get_value("instanceName")): part for part in profile.components}
    ports: dict[etree._Element, set[str]] = {}
    for connector in profile.connectors:
        for end in filter(None, profile.get_ends(connector)):
            owner = known.get((end.get_value("componentId"), end.get_value("instanceName")))
            if owner is None:
                yield _note("N06", end, f"component {end.get_value('instanceName')} ({end.get_value('componentId')})")
            elif not _has_port(ports, owner, end.get_value("portName")):
                yield _note("N06", end, f"port {end.get_value('portName')} of {end.get_value('instanceName')}")
    for targets in profile.orders.values():
        for condition in targets:
            preceding = [part for group in condition.list_parts("Preceding") for part in group.list_parts("PrecedingComponents")]
            for part in [*condition.list_parts("TargetComponent"), *preceding]:
                if (part.get_value("componentId"), part.get_value("instanceName")) not in known:
                    yield _note("N06", part, f"component {part.get_value('instanceName')} ({part.get_value('componentId')})")


def _has_port(ports: dict[etree._Element, set[str]], component: View, name: str) -> bool:
    """Tools write names of ports with and without the instance in front. @param ports cache of names. A component without ports can have any."""
    if component.element not in ports:
        ports[component.element] = {part.name.rpartition(".")[2] for part in component.list_parts("DataPorts", "ServicePorts")}
    names = ports[component.element]
    return not names or name.rpartition(".")[2] in names


def _find_duplicates(parts: Iterable[View], *names: str) -> Iterator[Deviation]:
    seen: set[tuple[str, ...]] = set()
    for part in parts:
        key = tuple(part.get_value(name) for name in names)
        if key in seen:
            yield _note("N07", part, key[0])
        seen.add(key)
