# SPDX-License-Identifier: Apache-2.0
"""Checks a profile against the schema of its version: that of the tables in `schema/`, or published files in a folder of the user.

libxml2 checks both, so that the verdict is that of `xmllint --schema`. No file is written and no network is used.

@satisfies SWR-PFL-002, SWR-PFL-003      Design: docs/design/profiles.md#schema
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from lxml import etree

from mamori_tools.profiles.schema_table import BUILT_IN, Child, ElementType, SchemaTable, load_table
from mamori_tools.profiles.xml_file import describe_path, get_local_name, shorten_names
from mamori_trace.base.errors import InputError

XSD = "http://www.w3.org/2001/XMLSchema"
OLD_PREFIX = {"0.1": "V1", "0.2": "V2"}
"""Published files of older versions have this prefix if files of a newer version are in the same folder. Their imports do not have it."""
MAIN_FILE = {"rtc": "RtcProfile_ext.xsd", "rts": "RtsProfile_ext.xsd"}
BASIC_FILE = {"rtc": "RtcProfile_basic.xsd", "rts": "RtsProfile.xsd"}
MARKS = {"rtc": {"0.1": b"subscriprionType", "0.3": b"EventPort"}, "rts": {"0.1": b"RTSystemProfile"}}
"""Text by which a published file shows its version. A file without a mark has version 0.2."""


@dataclass(frozen=True)
class Finding:
    """A violation of the schema. `place` is the path of the element."""

    line: int
    place: str
    text: str


def find_violations(root: etree._Element, family: str, version: str, folder: Path | None = None) -> list[Finding]:
    """@param folder folder with the published schema files; None: the tables. @raise InputError for a folder that cannot be used."""
    if folder is not None and not folder.is_dir():
        raise InputError("not a folder; specify the folder with the published schema files" if folder.exists() else "not found; check the path", folder)
    schema = _load_own(family, version) if folder is None else _load_published(family, version, folder)
    if schema.validate(root):
        return []
    table = load_table(family, version)
    steps: dict[etree._Element, dict[str, etree._Element]] = {}
    found: dict[Finding, None] = {}
    for error in schema.error_log:
        element = _find_element(root, error.path or "", steps)
        line = error.line or next((own.sourceline for own in (element, *element.iterancestors()) if own.sourceline), 1)
        found[Finding(line, describe_path(element, table), shorten_names(error.message, table))] = None
    return list(found)


def _find_element(root: etree._Element, path: str, steps: dict[etree._Element, dict[str, etree._Element]]) -> etree._Element:
    """@param path as libxml2 writes it. @param steps cache, the children by their step in such a path; a path of each element would take quadratic time."""
    element = root
    for step in path.split("/")[2:]:
        if element not in steps:
            steps[element] = _list_steps(element)
        element = steps[element].get(step, element)
    return element


def _list_steps(parent: etree._Element) -> dict[str, etree._Element]:
    children = list(parent.iterchildren("*"))
    names = [f"{child.prefix}:{get_local_name(child)}" if child.prefix else "*" if child.tag.startswith("{") else child.tag for child in children]
    totals, counts, found = Counter(names), Counter[str](), {}
    for position, (child, name) in enumerate(zip(children, names, strict=True), start=1):
        counts[name] += 1
        number, total = (position, len(children)) if name == "*" else (counts[name], totals[name])
        found[name if total == 1 else f"{name}[{number}]"] = child
    return found


class _Documents(etree.Resolver):
    """Resolves each imported document from `texts`; anything else is empty."""

    def __init__(self, texts: dict[str, bytes]) -> None:
        self._texts = texts

    def resolve(self, url: str, public_id: str, context: object) -> object:
        return self.resolve_string(self._texts.get(url.rpartition("/")[2], b""), context)


def _compile(texts: dict[str, bytes], main: str) -> etree.XMLSchema:
    parser = etree.XMLParser(no_network=True, resolve_entities=False)
    parser.resolvers.add(_Documents(texts))
    return etree.XMLSchema(etree.fromstring(texts[main], parser, base_url=main))


@cache
def _load_own(family: str, version: str) -> etree.XMLSchema:
    table = load_table(family, version)
    texts = {f"{prefix}.xsd": _make_document(table, prefix) for prefix in table.namespaces}
    return _compile(texts, f"{list(table.namespaces)[-1]}.xsd")


@cache
def _load_published(family: str, version: str, folder: Path) -> etree.XMLSchema:
    sets = [paths for own in [folder, *sorted(folder.glob("*/"))] if (paths := _list_schema_files(family, version, own))]
    if not sets:
        raise InputError(f"has no {MAIN_FILE[family]} of version {version}; specify the folder with the published schema files", folder)
    paths = min(sets, key=lambda own: len({path.name == name for name, path in own.items()}))  # the first set that is not mixed
    try:
        return _compile({name: path.read_bytes() for name, path in paths.items()}, MAIN_FILE[family])
    except (etree.XMLSyntaxError, etree.XMLSchemaParseError) as error:
        raise InputError(f"not a usable schema: {error}", paths[MAIN_FILE[family]]) from error


def _list_schema_files(family: str, version: str, folder: Path) -> dict[str, Path]:
    """The published files of a version in one folder, by the name in imports; empty if the folder has another version."""
    paths = {path.name: path for path in sorted(folder.glob(f"{family.title()}Profile*.xsd"))}
    for name, path in paths.items():
        old = path.with_name(OLD_PREFIX.get(version, "") + name)
        paths[name] = old if old.is_file() else path
    basic = paths.get(BASIC_FILE[family])
    content = b"" if basic is None else basic.read_bytes()
    found = next((own for own, mark in MARKS[family].items() if mark in content), version if basic is None else "0.2")
    return paths if MAIN_FILE[family] in paths and found == version else {}


def _make_document(table: SchemaTable, prefix: str) -> bytes:
    """The schema document of one namespace."""
    schema = etree.Element(f"{{{XSD}}}schema", nsmap={"xsd": XSD, **table.namespaces}, targetNamespace=table.namespaces[prefix],
                           elementFormDefault="qualified", attributeFormDefault="qualified")  # fmt: skip
    for other in list(table.namespaces)[: list(table.namespaces).index(prefix)]:
        etree.SubElement(schema, f"{{{XSD}}}import", namespace=table.namespaces[other], schemaLocation=f"{other}.xsd")
    if table.root.startswith(f"{{{table.namespaces[prefix]}}}"):
        etree.SubElement(schema, f"{{{XSD}}}element", name=table.root.rpartition("}")[2], type=table.root_type)
    for name, values in table.values.items():
        if name.startswith(f"{prefix}:"):
            _add_values(etree.SubElement(schema, f"{{{XSD}}}simpleType", name=name.partition(":")[2]), values)
    for own in table.types.values():
        if own.name.startswith(f"{prefix}:"):
            _add_type(schema, table, own)
    return bytes(etree.tostring(schema))


def _add_type(schema: etree._Element, table: SchemaTable, own: ElementType) -> None:
    node = etree.SubElement(schema, f"{{{XSD}}}complexType", name=own.name.partition(":")[2])
    if own.base:
        node = etree.SubElement(etree.SubElement(node, f"{{{XSD}}}complexContent"), f"{{{XSD}}}extension", base=own.base)
    if own.own_children:
        _add_children(etree.SubElement(node, f"{{{XSD}}}sequence"), own.own_children)
    for part in own.own_attributes:
        attribute = etree.SubElement(node, f"{{{XSD}}}attribute", name=part.name.rpartition("}")[2], use="required" if part.is_required else "optional")
        if part.type in table.values and ":" not in part.type:
            _add_values(etree.SubElement(attribute, f"{{{XSD}}}simpleType"), table.values[part.type])
        else:
            attribute.set("type", _qualify(part.type))


def _add_children(sequence: etree._Element, children: list[Child]) -> None:
    group: tuple[int | None, etree._Element] = (None, sequence)
    for part in children:
        if part.choice != group[0]:
            group = (part.choice, sequence if part.choice is None else etree.SubElement(sequence, f"{{{XSD}}}choice"))
        etree.SubElement(group[1], f"{{{XSD}}}element", name=part.name.rpartition("}")[2], type=_qualify(part.type),
                         minOccurs=str(part.least), maxOccurs="unbounded" if part.most is None else str(part.most))  # fmt: skip


def _add_values(simple: etree._Element, values: tuple[str, ...]) -> None:
    restriction = etree.SubElement(simple, f"{{{XSD}}}restriction", base="xsd:string")
    for value in values:
        etree.SubElement(restriction, f"{{{XSD}}}enumeration", value=value)


def _qualify(name: str) -> str:
    return f"xsd:{name}" if name in BUILT_IN else name
