# SPDX-License-Identifier: Apache-2.0
"""Changes a tree that tools really write into one that conforms to the schema, and names each change.

Only what has one probable meaning is changed. Names, ports, ids and directions of data are never invented. Only elements that no version of the
schema knows are ignored; a known element in a wrong place remains a violation.

@satisfies SWR-PFL-005      Design: docs/design/profiles.md#tolerant-mode
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from lxml import etree

from mamori_tools.profiles.attribute_value import find_meant, is_of_type
from mamori_tools.profiles.deviation import Deviation
from mamori_tools.profiles.schema_table import XSI, XSI_TYPE, Attribute, Child, ElementType, SchemaTable, list_element_names
from mamori_tools.profiles.xml_file import describe_path

UNKNOWN_DATE = "1970-01-01T00:00:00"
OTHER_NAMES = {
    "varname": "variableName", "variableName": "varname", "occurrence": "occerrence", "subscriptionType": "subscriprionType",
    "subscriprionType": "subscriptionType", "VersionUpLog": "VersionUpLogs", "VersionUpLogs": "VersionUpLog", "Component": "Components",
    "Components": "Component",
}  # fmt: skip
"""Names of other versions, and the right spelling of a name that the schema spells wrongly."""
PROPERTIES = {"dataType": "dataport.data_type", "interfaceType": "dataport.interface_type", "dataflowType": "dataport.dataflow_type"}
"""Attributes of a connector that its properties repeat."""
SUBSTITUTES = {
    "x": "0", "y": "0", "height": "-1", "width": "-1", "direction": "DOWN", "matchCase": "false",
    "creationDate": UNKNOWN_DATE, "updateDate": UNKNOWN_DATE, "defaultValue": "", "interfaceType": "", "dataflowType": "",
    "pathUri": "", "vendor": "", "category": "", "version": "",
}  # fmt: skip
"""Values of missing attributes. Drawing data and empty texts cannot be misunderstood; dates are marked by their year."""
ADDED_CHILDREN = ("Actions", "Location", "WaitTime")


def repair(root: etree._Element, table: SchemaTable) -> tuple[etree._Element, list[Deviation]]:
    """@return the root, which may be a new element, and what was changed, in the order of the file."""
    own = _Repair(table)
    root = own.prepare(root)
    own.visit(root, table.root_type)
    return root, sorted(own.found, key=lambda deviation: deviation.line)


class _Repair:
    def __init__(self, table: SchemaTable) -> None:
        self.found: list[Deviation] = []
        self._table = table
        self._ports: dict[tuple[str | None, str], etree._Element] | None = None

    def prepare(self, root: etree._Element) -> etree._Element:
        """Declares all prefixes at the root, because `xsi:type` needs them, and renames the root."""
        wanted = {prefix: uri for prefix, uri in {**self._table.namespaces, "xsi": XSI}.items() if uri not in root.nsmap.values()}
        line = root.sourceline
        if wanted:
            new = etree.Element(root.tag, dict(root.attrib), nsmap={**wanted, **root.nsmap})
            new.text = root.text
            new.extend(list(root))
            new.sourceline = line
            etree.ElementTree(new)
            root = new
        if root.tag != self._table.root:
            self._record("D13", root, f"{self._table.shorten(root.tag)} renamed to {self._table.shorten(self._table.root)}")
            root.tag = self._table.root
        return root

    def visit(self, element: etree._Element, declared: str) -> None:
        """@param declared type of the element in its parent."""
        if declared not in self._table.types:
            self._clear_simple(element)
            return
        own = self._table.types[self._find_type(element, declared)]
        self._check_attributes(element, own)
        self._name_children(element, own)
        self._check_text(element)
        self._count_children(element, own)
        self._order_children(element, own)
        for child in element.iterchildren("*"):
            if child.tag in own.children:  # others are violations
                self.visit(child, own.children[child.tag].type)

    def _record(self, number: str, element: etree._Element, repair: str) -> None:
        line = next((own.sourceline for own in (element, *element.iterancestors()) if own.sourceline), 1)
        self.found.append(Deviation(number, line, describe_path(element, self._table), repair))

    def _clear_simple(self, element: etree._Element) -> None:
        for name in [name for name in element.attrib if not name.startswith(f"{{{XSI}}}")]:
            self._record("D07", element, f"{self._table.shorten(name)} ignored")
            del element.attrib[name]
        for child in element.findall("*"):
            self._record("D08", child, "ignored")
            element.remove(child)

    def _find_type(self, element: etree._Element, declared: str) -> str:
        current = declared
        if XSI_TYPE in element.attrib:
            named = self._table.read_type(element)
            if self._table.is_derived(named, declared):
                current = named
            else:
                self._record("D02", element, f"xsi:type {element.attrib.pop(XSI_TYPE)} ignored")
        names = [*(name for name in element.attrib if not name.startswith(f"{{{XSI}}}")), *(child.tag for child in element.iterchildren("*"))]
        best = min([current, *self._table.list_extensions(current)], key=lambda name: self._count_unknown(names, name))
        if best != current:
            self._record("D01", element, f"xsi:type {best} added")
            self._set_type(element, best)
        return best

    def _count_unknown(self, names: list[str], type_: str) -> int:
        own = self._table.types[type_]
        return sum(name not in own.attributes and name not in own.children for name in names)

    def _set_type(self, element: etree._Element, type_: str) -> None:
        prefix, _, local = type_.partition(":")
        uri = self._table.namespaces[prefix]
        used = next(name for name, own in element.nsmap.items() if own == uri)
        element.set(XSI_TYPE, f"{used}:{local}" if used else local)

    def _check_attributes(self, element: etree._Element, own: ElementType) -> None:
        for name in [name for name in element.attrib if name not in own.attributes and not name.startswith(f"{{{XSI}}}")]:
            meant = self._find_name(name, own.attributes, lambda found: found not in element.attrib)
            value = element.attrib.pop(name)
            if meant is None:
                self._record("D07", element, f"{self._table.shorten(name)} ignored")
            else:
                element.set(meant, value)
                self._record("D09", element, f"{self._table.shorten(name)} read as {self._table.shorten(meant)}")
        for part in own.attributes.values():
            if part.name in element.attrib:
                self._check_value(element, part)
            elif part.is_required:
                value = self._find_substitute(element, part)
                if value is not None:
                    element.set(part.name, value)
                    self._record("D04", element, f"{self._table.shorten(part.name)}={value!r} added")

    def _check_value(self, element: etree._Element, part: Attribute) -> None:
        names = self._table.values.get(part.type, ())
        value, short = element.get(part.name), self._table.shorten(part.name)
        if is_of_type(value, part.type, names):
            return
        meant = find_meant(value, part.type, names)
        if meant is not None:
            element.set(part.name, meant)
            self._record("D15" if part.type == "dateTime" else "D05", element, f"{short}={value!r} read as {meant!r}")
        elif not part.is_required:
            del element.attrib[part.name]
            self._record("D06", element, f"{short}={value!r} ignored")
        elif part.type == "dateTime":
            element.set(part.name, UNKNOWN_DATE)
            self._record("D15", element, f"{short}={value!r} read as {UNKNOWN_DATE!r}")

    def _find_substitute(self, element: etree._Element, part: Attribute) -> str | None:
        local = part.name.rpartition("}")[2]
        values = {name.rpartition("}")[2]: value for name, value in element.attrib.items()}
        if local in PROPERTIES:
            return next((value for source in [element, *self._list_ports(element)] if (value := _get_property(source, PROPERTIES[local]))),
                        SUBSTITUTES.get(local))  # fmt: skip
        if local == "updateDate":
            return str(values.get("creationDate", UNKNOWN_DATE))
        if local == "position":
            word = "RIGHT" if values.get("portType") == "DataOutPort" else "LEFT"
            return find_meant(word, part.type, self._table.values[part.type])
        if local == "version" and element.getparent() is None:
            return self._table.version
        return None if part.type == "direction" else SUBSTITUTES.get(local)  # the direction of an interface cannot be guessed

    def _list_ports(self, connector: etree._Element) -> list[etree._Element]:
        """The ports that the connector names, as far as the components have them. Names of ports can begin with that of their instance."""
        if self._ports is None:
            self._ports = {}
            for port in connector.getroottree().getroot().iterfind("{*}Components/{*}DataPorts"):
                self._ports[_get_local(port.getparent(), "instanceName"), str(_get_local(port, "name")).rpartition(".")[2]] = port
        keys = [(_get_local(end, "instanceName"), str(_get_local(end, "portName")).rpartition(".")[2])
                for end in connector.iterchildren("{*}sourceDataPort", "{*}targetDataPort")]  # fmt: skip
        return [self._ports[key] for key in keys if key in self._ports]

    def _find_name(self, name: str, known: Iterable[str], is_free: Callable[[str], bool]) -> str | None:
        """The known name that `name` means: of another prefix, another version or another case."""
        local = name.rpartition("}")[2]
        names = {own.rpartition("}")[2]: own for own in known if is_free(own)}
        lower = {own.lower(): own for own in names}
        word = local if local in names else OTHER_NAMES.get(local, "")
        return names.get(word if word in names else lower.get(local.lower(), ""))

    def _name_children(self, element: etree._Element, own: ElementType) -> None:
        present = {child.tag for child in element.iterchildren("*")}
        for child in element.findall("*"):
            if child.tag in own.children:
                continue
            meant = self._find_name(child.tag, own.children, lambda name: own.children[name].most is None or name not in present)
            if meant is None and child.tag.rpartition("}")[2] not in list_element_names(self._table.family):
                self._record("D08", child, "ignored")
                self._remove(child)
            elif meant is not None:
                self._record("D09", child, f"read as {self._table.shorten(meant)}")
                child.tag = meant
                present.add(meant)

    @staticmethod
    def _remove(child: etree._Element) -> None:
        """Keeps the text after the element."""
        before, parent = child.getprevious(), child.getparent()
        if child.tail and before is not None:
            before.tail = (before.tail or "") + child.tail
        elif child.tail:
            parent.text = (parent.text or "") + child.tail
        parent.remove(child)

    def _check_text(self, element: etree._Element) -> None:
        texts = [element.text, *(child.tail for child in element)]
        if any(text and text.strip() for text in texts):
            self._record("D12", element, "ignored")
            element.text = None
            for child in element:
                child.tail = None

    @staticmethod
    def _get_group(part: Child) -> str:
        """Children of one choice share a limit."""
        return part.name if part.choice is None else f"choice {part.choice}"

    def _count_children(self, element: etree._Element, own: ElementType) -> None:
        counts: dict[str, int] = {}
        for child in element.findall("*"):
            part = own.children.get(child.tag)
            if part is None:
                continue
            group = self._get_group(part)
            counts[group] = counts.get(group, 0) + 1
            if part.most is not None and counts[group] > part.most:
                self._record("D11", child, "ignored")
                self._remove(child)
        for part in own.children.values():
            local = part.name.rpartition("}")[2]
            if part.least > counts.get(self._get_group(part), 0) and (local in ADDED_CHILDREN or local.startswith("On")):
                counts[self._get_group(part)] = 1
                child = etree.SubElement(element, part.name)
                if local.startswith("On"):
                    child.set(f"{part.name[: -len(local)]}implemented", "false")
                if local == "WaitTime":
                    child.set(part.name.replace("WaitTime", "waitTime"), "0")
                self._record("D10", element, f"{self._table.shorten(part.name)} added")

    def _order_children(self, element: etree._Element, own: ElementType) -> None:
        groups = list(dict.fromkeys(self._get_group(part) for part in own.children.values()))
        keys: list[int] = []
        for child in reversed(element):  # a comment belongs to the element that follows
            is_element = child.tag in own.children
            keys.append(groups.index(self._get_group(own.children[child.tag])) if is_element else keys[-1] if keys else len(groups))
        keys.reverse()
        if keys == sorted(keys):
            return
        tails = [child.tail for child in element]
        new = [child for _, child in sorted(zip(keys, element, strict=True), key=lambda pair: pair[0])]
        if not self._is_only_added(element, keys):
            self._record("D03", element, "sorted")
        element[:] = new
        for child, tail in zip(element, tails, strict=True):
            child.tail = tail

    def _is_only_added(self, element: etree._Element, keys: list[int]) -> bool:
        """Whether only elements without a line, which this repair added, are out of order."""
        old = [key for key, child in zip(keys, element, strict=True) if child.sourceline]
        return old == sorted(old)


def _get_local(element: etree._Element, local: str) -> str | None:
    return next((value for name, value in element.attrib.items() if name.rpartition("}")[2] == local), None)


def _get_property(element: etree._Element, name: str) -> str | None:
    return next((_get_local(child, "value") for child in element.iterchildren("{*}Properties") if _get_local(child, "name") == name), None)
