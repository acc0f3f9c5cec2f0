# SPDX-License-Identifier: Apache-2.0
"""The 97 fields of RTCBuilder's forms and their places in RTC.xml, for `profile show` and for generators.

@satisfies SWR-PFL-008      Design: docs/design/profiles.md#fields
Source: tables 5 to 13 of the predecessors' project report; places as in schema 0.3 (the older spelling after `|`)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lxml import etree

from mamori_tools.profiles.constraint_xml import format_constraint
from mamori_tools.profiles.schema_table import SchemaTable
from mamori_tools.profiles.xml_file import get_local_name

NO_NOTATION = "(no notation)"
"""Value of a constraint that only the schema knows."""

# Line with a colon: table of the report, title, element. Other lines: label (*: required) = XPath from the element; no XPath: the form repeats
# another field and stores nothing. The prefixes are those of the schema.
_TEXT = """
5 basic profile: rtc:BasicInfo
  module name* = @rtc:name
  module summary = @rtc:description
  version = @rtc:version
  vendor* = @rtc:vendor
  category* = @rtc:category
  component type* = @rtc:componentType
  activity type* = @rtc:activityType
  component kind* = @rtc:componentKind
  maximum instances = @rtc:maxInstances
  execution type* = @rtc:executionType
  execution rate = @rtc:executionRate
  abstract = @rtc:abstract
  RTC type = @rtc:rtcType
  output project* = @rtcExt:saveProject
6 activity: rtc:Actions
  onInitialize = rtc:OnInitialize/@rtc:implemented
  onFinalize = rtc:OnFinalize/@rtc:implemented
  onStartup = rtc:OnStartup/@rtc:implemented
  onShutdown = rtc:OnShutdown/@rtc:implemented
  onActivated = rtc:OnActivated/@rtc:implemented
  onDeactivated = rtc:OnDeactivated/@rtc:implemented
  onAborting = rtc:OnAborting/@rtc:implemented
  onError = rtc:OnError/@rtc:implemented
  onReset = rtc:OnReset/@rtc:implemented
  onExecute = rtc:OnExecute/@rtc:implemented
  onStateUpdate = rtc:OnStateUpdate/@rtc:implemented
  onRateChanged = rtc:OnRateChanged/@rtc:implemented
  onAction = rtc:OnAction/@rtc:implemented
  onModeChanged = rtc:OnModeChanged/@rtc:implemented
  activity name
  overview = */rtcDoc:Doc/@rtcDoc:description
  precondition = */rtcDoc:Doc/@rtcDoc:preCondition
  postcondition = */rtcDoc:Doc/@rtcDoc:postCondition
7 data port: rtc:DataPorts
  port name* = @rtc:name
  port name (display)
  data type* = @rtc:type
  variable name = @rtcExt:variableName | @rtcExt:varname
  position* = @rtcExt:position
  overview = rtcDoc:Doc/@rtcDoc:description
  type = rtcDoc:Doc/@rtcDoc:type
  number of data = rtcDoc:Doc/@rtcDoc:number
  meaning = rtcDoc:Doc/@rtcDoc:semantics
  unit = rtcDoc:Doc/@rtcDoc:unit
  occurrence, period = rtcDoc:Doc/@rtcDoc:occerrence
  processing rate = rtcDoc:Doc/@rtcDoc:operation
8 service port: rtc:ServicePorts
  port name* = @rtc:name
  position* = @rtcExt:position
  overview = rtcDoc:Doc/@rtcDoc:description
  interface description = rtcDoc:Doc/@rtcDoc:ifdescription
9 service interface: rtc:ServicePorts/rtc:ServiceInterface
  interface name* = @rtc:name
  direction* = @rtc:direction
  instance name* = @rtc:instanceName
  variable name = @rtcExt:variableName | @rtc:varname
  IDL file* = @rtc:idlFile
  interface type* = @rtc:type
  IDL search path = @rtc:path
  overview = rtcDoc:Doc/@rtcDoc:description
  arguments = rtcDoc:Doc/@rtcDoc:docArgument
  return value = rtcDoc:Doc/@rtcDoc:docReturn
  exceptions = rtcDoc:Doc/@rtcDoc:docException
  precondition = rtcDoc:Doc/@rtcDoc:docPreCondition
  postcondition = rtcDoc:Doc/@rtcDoc:docPostCondition
10 configuration: rtc:ConfigurationSet/rtc:Configuration
  parameter name* = @rtc:name
  parameter name (display)
  data type* = @rtc:type
  default value* = @rtc:defaultValue
  variable name = @rtcExt:variableName | @rtc:varname
  unit = @rtc:unit
  constraint = rtc:Constraint
  widget* = rtcExt:Properties[@rtcExt:name='__widget__']/@rtcExt:value
  step = rtcExt:Properties[@rtcExt:name='__widget__'][contains(@rtcExt:value, '.')]/@rtcExt:value
  name of the documentation (display)
  data name = rtcDoc:Doc/@rtcDoc:dataname
  default value (documentation) = rtcDoc:Doc/@rtcDoc:defaultValue
  overview = rtcDoc:Doc/@rtcDoc:description
  unit (documentation) = rtcDoc:Doc/@rtcDoc:unit
  range = rtcDoc:Doc/@rtcDoc:range
  constraint in words = rtcDoc:Doc/@rtcDoc:constraint
10 system configuration: rtc:Parameters
  name* = @rtc:name
  default value = @rtc:defaultValue
12 documents: rtc:BasicInfo
  overview = rtcDoc:Doc/@rtcDoc:description
  input and output = rtcDoc:Doc/@rtcDoc:inout
  algorithm = rtcDoc:Doc/@rtcDoc:algorithm
  author, contact = rtcDoc:Doc/@rtcDoc:creator
  licence = rtcDoc:Doc/@rtcDoc:license
  references = rtcDoc:Doc/@rtcDoc:reference
  log of this change = (rtcExt:VersionUpLogs | rtcExt:VersionUpLog)[last()]
  previous logs = (rtcExt:VersionUpLogs | rtcExt:VersionUpLog)[position() < last()]
13 language and environment: rtc:Language
  language* = @rtc:kind | rtc:*
  language version = rtcExt:targets/@rtcExt:langVersion
  OS = rtcExt:targets/@rtcExt:os | rtc:*/@rtc:os
  OS version = rtcExt:targets/rtcExt:osVersions
  CPU = rtcExt:targets/rtcExt:cpus | rtc:*/@rtc:arch
  other OS = rtcExt:targets/@rtcExt:other
  other CPU = rtcExt:targets/@rtcExt:cpuOther
  library name* = rtcExt:targets/rtcExt:libraries/@rtcExt:name | rtc:*/rtc:library
  library version = rtcExt:targets/rtcExt:libraries/@rtcExt:version
  library information = rtcExt:targets/rtcExt:libraries/@rtcExt:other
"""


@dataclass(frozen=True)
class Field:
    """`number` counts from 1. `owner` and `place` are XPaths; `place` is empty if the form only repeats another field."""

    number: int
    table: int
    title: str
    label: str
    is_required: bool
    owner: str
    place: str


@dataclass(frozen=True)
class FieldValue:
    """A value in a file. `owner` is the element that has the field; `part` the name of the action, if the field is that of an action."""

    field: Field
    owner: etree._Element
    value: str
    part: str = ""


def _read_fields() -> tuple[Field, ...]:
    found: list[Field] = []
    table, title, owner = 0, "", ""
    for line in filter(None, _TEXT.splitlines()):
        if not line.startswith(" "):
            head, _, owner = line.partition(": ")
            number, _, title = head.partition(" ")
            table = int(number)
            continue
        label, _, place = line.strip().partition(" = ")
        found.append(Field(len(found) + 1, table, title, label.rstrip("*"), label.endswith("*"), owner, place))
    return tuple(found)


FIELDS = _read_fields()


def read_fields(root: etree._Element, table: SchemaTable) -> list[FieldValue]:
    """The values of all fields that the file has, in the order of the forms and, within a form, of the file."""
    found = []
    for owner_path in dict.fromkeys((field.title, field.owner) for field in FIELDS):
        fields = [field for field in FIELDS if (field.title, field.owner) == owner_path and field.place]
        for owner in root.xpath(owner_path[1], namespaces=table.namespaces):
            for field in fields:
                for node in owner.xpath(field.place, namespaces=table.namespaces):
                    part = get_local_name(node.getparent().getparent()) if field.place.startswith("*/") else ""
                    found.append(FieldValue(field, owner, _get_text(field, node), part))
    return found


def _get_text(field: Field, node: Any) -> str:
    """The value of an attribute or the text of an element. Widget and step share a value: `slider.0.01`. In 0.1, the name of an element is the language."""
    if isinstance(node, str):
        kind, _, step = node.partition(".")
        return step if field.label == "step" else kind if field.label == "widget" else str(node)
    if field.label == "constraint":
        return format_constraint(node) or NO_NOTATION
    return get_local_name(node) if field.label == "language" else (node.text or "").strip()
