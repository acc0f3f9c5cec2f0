# SPDX-License-Identifier: Apache-2.0
"""Seeded changes of a profile: the deviations that tools really write, and arbitrary ones."""

from __future__ import annotations

import copy
import random

from lxml import etree

from mamori_tools.profiles.schema_table import XSI_TYPE, SchemaTable

VALUES = ("", " ", "true", "True", "0", "1", "-1", "1.5", "1e3", "INF", "100 ", "abc", "PERIODOC", "EVENT_DRIVEN", "EventPort", "Provided", "PROVIDED",
          "left", "LEFT", "down", "DOWN", "None", "AllShared", "2020-01-02T03:04:05", "2020-01-02T03:04:05.678+09:00", "2020/01/02 03:04:05",
          "2020-13-02T03:04:05", "0.1", "0.2", "0.3", "99999999999999999999")  # fmt: skip


def mutate(root: etree._Element, table: SchemaTable, seed: int) -> etree._Element:
    """@return a copy of `root` with 1 to 3 changes. It has at least the root element."""
    choose = random.Random(seed)
    root = copy.deepcopy(root)
    for _ in range(choose.randint(1, 3)):
        elements = [element for element in root.iter() if isinstance(element.tag, str)]
        choose.choice(CHANGES)(choose.choice(elements), table, choose)
    return root


def drop_attribute(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    if element.attrib:
        del element.attrib[choose.choice(sorted(element.attrib))]


def set_value(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    if element.attrib:
        element.set(choose.choice(sorted(element.attrib)), choose.choice(VALUES))


def change_case(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    if element.attrib:
        name = choose.choice(sorted(element.attrib))
        element.set(name, choose.choice((str.lower, str.upper, str.title, str.strip))(element.get(name)))


def add_attribute(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    names = sorted({name for own in table.types.values() for name in own.attributes})
    element.set(choose.choice((choose.choice(names), choose.choice(names).rpartition("}")[2], "extra")), choose.choice(VALUES))


def move_attribute(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    if element.attrib:
        name = choose.choice(sorted(element.attrib))
        space = choose.choice(sorted(table.namespaces.values()))
        element.set(f"{{{space}}}{name.rpartition('}')[2]}", element.attrib.pop(name))


def drop_element(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    parent = element.getparent()
    if parent is not None:
        parent.remove(element)


def double_element(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    if element.getparent() is not None:
        element.addnext(copy.deepcopy(element))


def shift_element(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    parent = element.getparent()
    if parent is not None:
        parent.remove(element)
        parent.insert(choose.randint(0, len(parent)), element)


def rename_element(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    names = sorted({name for own in table.types.values() for name in own.children} | {table.root})
    if element.getparent() is not None:
        element.tag = choose.choice(names)


def add_element(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    names = sorted({name for own in table.types.values() for name in own.children})
    element.insert(choose.randint(0, len(element)), etree.Element(choose.choice(names)))


def set_type(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    choice = choose.random()
    if choice < 0.3 and XSI_TYPE in element.attrib:
        del element.attrib[XSI_TYPE]
    elif choice < 0.4:
        element.set(XSI_TYPE, choose.choice(("nothing", "rtcExt:nothing", "other:basic_info_ext", "")))
    else:
        local = etree.QName(element).localname.lower().rstrip("s")
        names = sorted([*table.types, *(name for name in table.values if ":" in name)])
        alike = [name for name in names if local[:6] in name.replace("_", "")]
        element.set(XSI_TYPE, choose.choice(alike or names))


def add_text(element: etree._Element, table: SchemaTable, choose: random.Random) -> None:
    element.text = choose.choice(("text", " ", "\n"))


CHANGES = (drop_attribute, set_value, set_value, change_case, add_attribute, move_attribute, drop_element, double_element, shift_element,
           rename_element, add_element, set_type, set_type, add_text)  # fmt: skip
