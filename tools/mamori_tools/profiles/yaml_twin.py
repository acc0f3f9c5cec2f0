# SPDX-License-Identifier: Apache-2.0
"""The YAML form of an RTS profile: to and from the tree of its XML form, without loss.

Keys are the names of attributes and elements with a small first letter; those of the extension begin with `rtsExt::`. Repeated elements are lists,
dates are maps, the choice of a condition is in the map `condition`. What the form of other tools cannot express has keys that they ignore:
`fraction` and `zone` of a date, and `xsi::type` for an element whose type is not its extension.

@satisfies SWR-PFL-006      Design: docs/design/profiles.md#yaml-form
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml
from lxml import etree

from mamori_tools.profiles.attribute_value import BOOLEANS, DATE, INTEGER
from mamori_tools.profiles.deviation import Deviation
from mamori_tools.profiles.schema_table import XSI, XSI_TYPE, Attribute, Child, ElementType, SchemaTable
from mamori_tools.profiles.xml_file import describe_path
from mamori_trace.base.errors import InputError

TOP = "rtsProfile"
TYPE_KEY = "xsi::type"
LINE_ENDS = re.compile("[\x85\u2028\u2029]")
NUMBER = re.compile(r"-?(0|[1-9][0-9]{0,14})(\.[0-9]{1,15})?")
DATE_KEYS = ("year", "month", "day", "hour", "minute", "second")
NULL = "tag:yaml.org,2002:null"
NOT_XML = re.compile("[^\\t\\n\\r\\x20-\\ud7ff\\ue000-\\ufffd\\U00010000-\\U0010ffff]")
DEPTH_MAX = 32
LINE_MAX = 65535  # lines that libxml2 counts


class _Key(str):
    """A key with a colon, which other readers know in quotes."""

    __slots__ = ()


class _Dumper(yaml.SafeDumper):
    pass


def _represent_text(dumper: Any, text: str) -> Any:
    """Quotes line ends that plain YAML would read as a space."""
    return dumper.represent_scalar("tag:yaml.org,2002:str", text, style='"' if LINE_ENDS.search(text) else None)


_Dumper.add_representer(str, _represent_text)
_Dumper.add_representer(_Key, lambda dumper, key: dumper.represent_scalar("tag:yaml.org,2002:str", key, style='"'))


def format_yaml(root: etree._Element, table: SchemaTable) -> str:
    """@param root a valid tree."""
    content = {TOP: _make_map(root, table.root_type, table)}
    return str(yaml.dump(content, Dumper=_Dumper, sort_keys=False, allow_unicode=True, default_flow_style=False, width=10**6))


def list_losses(root: etree._Element) -> list[str]:
    """What the YAML form does not keep."""
    comments = sum(not isinstance(node.tag, str) for node in root.getroottree().iter())
    losses = [f"{comments} comments"] if comments else []
    return losses + [f"attribute {name}" for name in root.attrib if name.startswith(f"{{{XSI}}}") and name != XSI_TYPE]


def parse_yaml(data: bytes, path: Path, table: SchemaTable) -> tuple[etree._Element, list[Deviation]]:
    """@return the tree of the XML form and the unknown keys. @raise InputError with the line for text that is not the YAML form."""
    node = _compose(data, path)
    if not isinstance(node, yaml.MappingNode) or [key.value for key, _ in node.value] != [TOP]:
        raise InputError(f"not the YAML form of an RTS profile: its only key must be {TOP}", path, node.start_mark.line + 1 if node else 1)
    root = etree.Element(table.root, nsmap={**table.namespaces, "xsi": XSI})
    reader = _Reader(table, path)
    reader.fill(root, node.value[0][1], table.root_type)
    etree.indent(root, "    ")
    return root, reader.found


def _compose(data: bytes, path: Path) -> Any:
    """The nodes of the document. Aliases are rejected: they could expand without limit."""
    depth = 0
    try:
        for event in yaml.parse(data, Loader=yaml.CSafeLoader):
            depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
            line = event.start_mark.line + 1 if event.start_mark else 1
            if isinstance(event, yaml.AliasEvent):
                raise InputError("has an alias; write its content", path, line)
            if depth > DEPTH_MAX:
                raise InputError(f"nested deeper than {DEPTH_MAX} levels; specify a profile", path, line)
        return yaml.compose(data, Loader=yaml.CSafeLoader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        raise InputError(f"not well-formed YAML: {error.problem}; correct the file or restore it", path, mark.line + 1 if mark else 1) from error
    except yaml.reader.ReaderError as error:
        line = data.count(b"\n", 0, error.position if isinstance(error.position, int) else 0) + 1
        raise InputError(f"not text in UTF-8: {error.reason}; save the file as UTF-8", path, line) from error


def _get_home(own: ElementType, table: SchemaTable) -> str:
    """The namespace whose names need no prefix in the map of the type."""
    while own.base:
        own = table.types[own.base]
    return table.namespaces[own.name.partition(":")[0]]


def _make_key(name: str, own: ElementType, table: SchemaTable) -> str:
    uri, _, local = name[1:].rpartition("}")
    local = local[0].lower() + local[1:]
    return local if uri == _get_home(own, table) else _Key(f"{table.shorten(name).partition(':')[0]}::{local}")


def expect_type(declared: str, table: SchemaTable, names: set[str]) -> str:
    """The type that an element with these attributes and children has in files: its extension, if it has what the extension requires; the root
    only if it uses the extension."""
    best = table.types[[declared, *table.list_extensions(declared)][-1]]
    if declared == table.root_type:
        own = {*(part.name for part in best.own_attributes), *(part.name for part in best.own_children)}
        return best.name if own & names else declared
    return best.name if all(part.least == 0 or part.name in names for part in best.own_children) else declared


def list_names(element: etree._Element) -> set[str]:
    """Names of the attributes and child elements."""
    return {*element.attrib, *(child.tag for child in element.iterchildren("*"))}


def _make_map(element: etree._Element, declared: str, table: SchemaTable) -> dict[str, Any]:
    actual = table.read_type(element) or declared
    own = table.types[actual]
    content: dict[str, Any] = {}
    expected = expect_type(declared, table, list_names(element))
    if (actual, XSI_TYPE in element.attrib) != (expected, expected != declared):
        content[_Key(TYPE_KEY)] = actual if XSI_TYPE in element.attrib else ""
    for attribute in own.attributes.values():
        if attribute.name in element.attrib:
            content[_make_key(attribute.name, own, table)] = _make_scalar(element.get(attribute.name), attribute)
    for child in own.children.values():
        for found in element.iterchildren(child.name):
            is_text = child.type not in table.types
            value = (found.text or "") if is_text else _make_map(found, child.type, table)
            key = _make_key(child.name, own, table)
            if child.choice is not None:
                content["condition"] = {key: value}
            elif child.most is None:
                content.setdefault(key, []).append(value)
            else:
                content[key] = value
    return content


def _make_scalar(text: str, attribute: Attribute) -> Any:
    if attribute.type == "boolean" and text in ("true", "false"):
        return text == "true"
    if attribute.type in ("integer", "double") and NUMBER.fullmatch(text):
        number = float(text) if "." in text else int(text)
        return number if str(number) == text else text
    match = DATE.fullmatch(text) if attribute.type == "dateTime" else None
    if match is None:
        return text
    parts: dict[str, Any] = {key: int(part) for key, part in zip(DATE_KEYS, match.groups()[:6], strict=True)}
    return {**parts, **({"fraction": match[7]} if match[7] else {}), **({"zone": match[8]} if match[8] else {})}


class _Reader:
    """Fills elements from nodes."""

    def __init__(self, table: SchemaTable, path: Path) -> None:
        self.found: list[Deviation] = []
        self._table = table
        self._path = path

    def fill(self, element: etree._Element, node: Any, declared: str) -> None:
        element.sourceline = min(node.start_mark.line + 1, LINE_MAX)
        pairs = dict(self._list_pairs(node))
        explicit = pairs.pop(TYPE_KEY, None)
        widest = self._table.types[[declared, *self._table.list_extensions(declared)][-1]]
        own = widest
        if explicit is not None:
            name = self._read_text(explicit) or declared
            own = self._table.types[name] if self._table.is_derived(name, declared) else widest
            if own.name != name:
                self._record("D02", explicit, element, f"{TYPE_KEY} {name} ignored")
                explicit = None
        keys = {_make_key(name, own, self._table): name for name in [*own.attributes, *own.children]}
        actual = own.name if explicit is not None else expect_type(declared, self._table, {keys[key] for key in pairs if key in keys})
        if actual != declared or (explicit is not None and explicit.value):
            element.set(XSI_TYPE, actual)
        for attribute in own.attributes.values():
            value = pairs.pop(_make_key(attribute.name, own, self._table), None)
            if value is not None and value.tag != NULL:
                element.set(attribute.name, self._read_scalar(value, attribute, element))
        condition = pairs.pop("condition", None) if any(child.choice is not None for child in own.children.values()) else None
        choices = dict(self._list_pairs(condition)) if condition is not None else {}
        for child in own.children.values():
            source = pairs if child.choice is None else choices
            value = source.pop(_make_key(child.name, own, self._table), None)
            if value is not None and value.tag != NULL:
                self._add(element, child, value)
        for key, value in [*pairs.items(), *choices.items()]:
            self._record("D20", value, element, "ignored", key)

    def _record(self, number: str, node: Any, element: etree._Element, repair: str, key: str = "") -> None:
        place = describe_path(element, self._table)
        self.found.append(Deviation(number, node.start_mark.line + 1, f"{place}: {key}" if key else place, repair))

    def _add(self, element: etree._Element, child: Child, node: Any) -> None:
        if child.most is None and not isinstance(node, yaml.SequenceNode):
            raise InputError("a list is expected here", self._path, node.start_mark.line + 1)
        for item in node.value if child.most is None else [node]:
            new = etree.SubElement(element, child.name)
            if child.type in self._table.types:
                self.fill(new, item, child.type)
            else:
                new.text = self._read_text(item)

    def _list_pairs(self, node: Any) -> Iterator[tuple[str, Any]]:
        if not isinstance(node, yaml.MappingNode):
            raise InputError("a map of keys and values is expected here", self._path, node.start_mark.line + 1)
        seen: set[str] = set()
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode) or key.value in seen:
                text = f"the key {key.value} occurs more than once" if isinstance(key, yaml.ScalarNode) else "a key is not text"
                raise InputError(f"{text}; keep one", self._path, key.start_mark.line + 1)
            seen.add(key.value)
            yield key.value, value

    def _read_text(self, node: Any) -> str:
        if not isinstance(node, yaml.ScalarNode):
            raise InputError("a single value is expected here", self._path, node.start_mark.line + 1)
        text = str(node.value)
        if NOT_XML.search(text):
            raise InputError("a control character or U+FFFE cannot be part of a profile; remove it", self._path, node.start_mark.line + 1)
        return text

    def _read_scalar(self, node: Any, attribute: Attribute, element: etree._Element) -> str:
        if attribute.type == "dateTime" and isinstance(node, yaml.MappingNode):
            parts = {key: self._read_text(value) for key, value in self._list_pairs(node)}
            try:
                year, *rest = [int(INTEGER.fullmatch(parts.pop(key))[0]) for key in DATE_KEYS]  # type: ignore[index]  # TypeError for no match
            except (KeyError, TypeError) as error:
                raise InputError(f"a date is a map of integers: {', '.join(DATE_KEYS)}", self._path, node.start_mark.line + 1) from error
            fraction, zone = parts.pop("fraction", ""), parts.pop("zone", "")
            for key in parts:
                self._record("D20", node, element, "ignored", f"{self._table.shorten(attribute.name)}/{key}")
            return "{:04}-{:02}-{:02}T{:02}:{:02}:{:02}".format(year, *rest) + fraction + zone
        text = self._read_text(node)
        is_plain_boolean = attribute.type == "boolean" and node.tag == "tag:yaml.org,2002:bool"
        return BOOLEANS.get(text.lower(), text) if is_plain_boolean else text
