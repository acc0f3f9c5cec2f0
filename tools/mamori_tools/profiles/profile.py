# SPDX-License-Identifier: Apache-2.0
"""Loads a profile of any form: what it is, whether it conforms, and its lossless content.

@satisfies SWR-PFL-001, SWR-PFL-004, SWR-PFL-005      Design: docs/design/profiles.md#files
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mamori_tools.profiles.conf_file import ConfFile
from mamori_tools.profiles.deviation import Deviation
from mamori_tools.profiles.repair import repair
from mamori_tools.profiles.schema_check import Finding, find_violations
from mamori_tools.profiles.schema_table import SchemaTable, list_versions, load_table
from mamori_tools.profiles.xml_file import get_local_name, parse_xml, read_bytes
from mamori_tools.profiles.yaml_twin import parse_yaml
from mamori_trace.base.errors import InputError

CONF = "conf"
FAMILY_ROOTS = {"RtcProfile": "rtc", "RtsProfile": "rts", "RTSystemProfile": "rts"}
YAML_START = re.compile(rb"""(#[^\n]*+\n|\s|---)*+["']?rtsProfile["']?\s*:""")
CONF_LINE = re.compile(rb"^[ \t]*(config|corba|corba_servant|exec_cxt|logger|manager|naming|openrtm|os|port|sdo|timer)\.[\w.%-]+[ \t]*[:=]", re.MULTILINE)
"""A key of OpenRTM's manager."""
IGNORED = ("D07", "D08", "D11")
"""Deviations whose content is not loaded."""
TITLES = {"rtc": "RTC profile", "rts": "RTS profile", CONF: "rtc.conf"}


@dataclass
class Profile:
    """`family` is rtc, rts or conf; `form` is xml, yaml or conf. `root` is the tree of the first two, in the tolerant mode the repaired one;
    `conf` the content of the last. `violations` make the profile invalid. `data` are the bytes of the file."""

    path: Path
    data: bytes
    family: str
    form: str
    version: str = ""
    root: Any = None
    conf: ConfFile | None = None
    violations: list[Finding] = field(default_factory=list)
    deviations: list[Deviation] = field(default_factory=list)

    @property
    def title(self) -> str:
        return f"{TITLES[self.family]} {self.version}".strip() + (" (YAML)" if self.form == "yaml" else "")

    @property
    def table(self) -> SchemaTable:
        return load_table(self.family, self.version)


def load_profile(path: Path, tolerant: bool = False, schema: Path | None = None) -> Profile:
    """@param schema folder with the published schema files; None: the own tables.
    @raise InputError with file and line if the file cannot be read."""
    return parse_profile(read_bytes(path), path, tolerant, schema)


def parse_profile(data: bytes, path: Path, tolerant: bool = False, schema: Path | None = None) -> Profile:
    """The same for the content of a file."""
    if not data.strip():
        raise InputError("is empty; specify a profile", path)
    suffixes = [suffix.lower() for suffix in path.suffixes]
    if data.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<") or data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return _load_xml(path, data, tolerant, schema)
    if YAML_START.match(data.removeprefix(b"\xef\xbb\xbf")) or suffixes[-1:] in ([".yaml"], [".yml"]):
        return _load_yaml(path, data, tolerant, schema)
    if ".conf" in suffixes or CONF_LINE.search(data):
        return _load_conf(path, data, tolerant)
    raise InputError("not a profile: neither XML, nor the YAML form, nor rtc.conf; specify another file", path)


def _load_conf(path: Path, data: bytes, tolerant: bool) -> Profile:
    if b"\0" in data:
        raise InputError("has a zero byte; specify a text file", path, data.count(b"\n", 0, data.index(b"\0")) + 1)
    conf = ConfFile(data)
    own = Profile(path, data, CONF, CONF, conf=conf)
    if tolerant:
        own.deviations = conf.deviations
    else:
        own.violations = [_convert(deviation) for deviation in conf.deviations]
    return own


def _load_yaml(path: Path, data: bytes, tolerant: bool, schema: Path | None) -> Profile:
    version = list_versions("rts")[-1]
    table = load_table("rts", version)
    root, unknown = parse_yaml(data, path, table)
    own = Profile(path, data, "rts", "yaml", version, root)
    if tolerant:
        own.root, found = repair(root, table)
        own.deviations = [*_mark_version(own.root, table), *unknown, *found]
    own.violations = ([] if tolerant else [_convert(deviation) for deviation in unknown]) + find_violations(own.root, "rts", version, schema)
    return own


def _load_xml(path: Path, data: bytes, tolerant: bool, schema: Path | None) -> Profile:
    root = parse_xml(data, path).getroot()
    family = FAMILY_ROOTS.get(get_local_name(root))
    if family is None:
        raise InputError(f"is XML, but not a profile: its root is {get_local_name(root)}", path, root.sourceline)
    versions = list_versions(family)
    marked = get_marked_version(root)
    own = Profile(path, data, family, "xml", marked if marked in versions else versions[-1], root)
    if tolerant:
        _repair(own, marked, versions, schema)
    else:
        own.violations = find_violations(root, family, own.version, schema)
    return own


def _repair(own: Profile, marked: str, versions: tuple[str, ...], schema: Path | None) -> None:
    """Reads the file as the version with the least lost content and the fewest deviations; the marked one if others are not better."""
    results = []
    for version in [own.version, *(other for other in reversed(versions) if other != own.version)]:
        root, found = repair(parse_xml(own.data, own.path).getroot(), load_table(own.family, version))
        found = [*_mark_version(root, load_table(own.family, version), marked), *found]
        violations = find_violations(root, own.family, version, schema)
        ignored = sum(deviation.id in IGNORED for deviation in found)
        results.append(((len(violations), ignored, len(found)), version, root, found, violations))
        if not found and not violations:
            break
    _, own.version, own.root, own.deviations, own.violations = min(results, key=lambda result: result[0])


def get_marked_version(root: Any) -> str:
    return next((str(value) for name, value in root.attrib.items() if name.rpartition("}")[2] == "version"), "")


def _mark_version(root: Any, table: SchemaTable, marked: str | None = None) -> list[Deviation]:
    """Sets the version of a repaired root to the version as which it was read. @param marked version in the file; None: that of the root."""
    marked = get_marked_version(root) if marked is None else marked
    if marked == table.version:
        return []
    root.set(f"{table.root.rpartition('}')[0]}}}version", table.version)
    return [Deviation("D14", root.sourceline or 1, "", f"marked {marked!r}, read as {table.version}")]


def _convert(deviation: Deviation) -> Finding:
    return Finding(deviation.line, deviation.place, deviation.sentence)
