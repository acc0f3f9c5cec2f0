# SPDX-License-Identifier: Apache-2.0
"""Named parts of a valid or repaired tree. A view stores nothing: reading and writing go to the tree, whose other parts stay as they are.

@satisfies SWR-PFL-001      Design: docs/design/profiles.md#files
"""

from __future__ import annotations

from dataclasses import dataclass

from lxml import etree

from mamori_tools.profiles.schema_table import SchemaTable


@dataclass(frozen=True)
class View:
    """One element."""

    element: etree._Element
    table: SchemaTable

    @property
    def line(self) -> int:
        """That of the parent for an element that a repair added."""
        return next((int(own.sourceline) for own in (self.element, *self.element.iterancestors()) if own.sourceline), 1)

    @property
    def name(self) -> str:
        return self.get_value("name")

    def get_value(self, local: str) -> str:
        """The attribute, of the profile or its extension; empty if it is missing."""
        names = (f"{{{uri}}}{local}" for uri in self.table.namespaces.values())
        return next((str(self.element.get(name)) for name in names if name in self.element.attrib), "")

    def set_value(self, local: str, value: str) -> None:
        """Changes an attribute that the element has. @raise KeyError for another one."""
        names = (f"{{{uri}}}{local}" for uri in self.table.namespaces.values())
        name = next((name for name in names if name in self.element.attrib), None)
        if name is None:
            raise KeyError(local)
        self.element.set(name, value)

    def get_documentation(self, local: str) -> str:
        """The attribute of `rtcDoc:Doc`; empty if it is missing."""
        found = self.list_parts("Doc")
        return found[0].get_value(local) if found else ""

    def list_parts(self, *locals_: str) -> list[View]:
        """Child elements of these names."""
        return [View(child, self.table) for child in self.element.iterchildren(*(f"{{*}}{local}" for local in locals_))]

    @property
    def properties(self) -> dict[str, str]:
        return {part.name: part.get_value("value") for part in self.list_parts("Properties")}


class RtcView(View):
    """An RTC profile."""

    @property
    def basic(self) -> View:
        return self.list_parts("BasicInfo")[0]

    @property
    def actions(self) -> dict[str, View]:
        """For example `OnExecute`; `implemented` is "true" or "1" if the component has the action."""
        return {part.element.tag.rpartition("}")[2]: part for group in self.list_parts("Actions") for part in group.list_parts("*")}

    @property
    def configurations(self) -> list[View]:
        return [part for group in self.list_parts("ConfigurationSet") for part in group.list_parts("Configuration")]

    @property
    def data_ports(self) -> list[View]:
        return self.list_parts("DataPorts")

    @property
    def service_ports(self) -> list[View]:
        """Their parts `ServiceInterface` are the interfaces."""
        return self.list_parts("ServicePorts")

    @property
    def language(self) -> str:
        """In 0.1, the name of the child element."""
        found = self.list_parts("Language")
        return next((part.get_value("kind") or next((child.element.tag.rpartition("}")[2] for child in part.list_parts("*")), "") for part in found), "")


ORDERS = ("StartUp", "ShutDown", "Activation", "Deactivation", "Resetting", "Initializing", "Finalizing")


class RtsView(View):
    """An RTS profile."""

    @property
    def components(self) -> list[View]:
        return self.list_parts("Components", "Component")

    @property
    def connectors(self) -> list[View]:
        """Of data and service ports; in 0.1 they are parts of the source port."""
        kinds = ("DataPortConnectors", "ServicePortConnectors")
        inner = [part for own in self.components for port in own.list_parts("DataPorts", "ServicePorts") for part in port.list_parts(*kinds)]
        return [*self.list_parts(*kinds), *inner]

    @staticmethod
    def get_ends(connector: View) -> tuple[View | None, View]:
        """Source (None in 0.1) and target: componentId, instanceName, portName."""
        source = connector.list_parts("sourceDataPort", "sourceServicePort")
        return (source[0] if source else None), connector.list_parts("targetDataPort", "targetServicePort")[0]

    @property
    def orders(self) -> dict[str, list[View]]:
        """The conditions of each order, for example of `StartUp`."""
        return {part.element.tag.rpartition("}")[2]: part.list_parts("targets") for part in self.list_parts(*ORDERS)}
