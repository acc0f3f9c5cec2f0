# SPDX-License-Identifier: Apache-2.0
"""Finds component packages, folders with an RTC.xml, and resolves the components of a system to them.

@satisfies SWR-PFL-012, SWR-PFL-013      Design: docs/design/profiles.md#packages
"""

from __future__ import annotations

import fnmatch
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mamori_tools.profiles.profile import Profile, load_profile
from mamori_tools.profiles.view import RtcView, RtsView
from mamori_tools.profiles.xml_file import MAX_BYTES
from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names

ROOT = re.compile(rb"(\s|\xef\xbb\xbf|\xff\xfe|\xfe\xff|<\?.*?\?>|<!--.*?-->|<!DOCTYPE[^\[>]*(\[.*?\]\s*)?>)*+<([\w.-]+:)?RtcProfile\b", re.DOTALL)
FILES_MAX = 10000
HIDDEN = re.compile(r"\..*|build([-_].*)?|node_modules")
"""Names of folders that are not searched."""


@dataclass(frozen=True)
class Package:
    """A component description that can be read. `path` is its RTC.xml."""

    path: Path
    profile: Profile
    view: RtcView

    @property
    def id(self) -> str:
        return self.view.get_value("id")

    @property
    def ids(self) -> tuple[str, ...]:
        """The id, and its form in profiles of version 0.1."""
        vendor, category, name, version = (self.view.basic.get_value(part) for part in ("vendor", "category", "name", "version"))
        return self.id, f"RTC:{vendor}.{category}.{name}:{version}"


KEYS = ("id", "name", "vendor", "category", "version", "summary", "component-type", "activity-type", "kind", "execution-type", "language",
        "port", "data-type", "service", "service-type", "parameter")  # fmt: skip
_BASIC = {"name": "name", "vendor": "vendor", "category": "category", "version": "version", "summary": "description", "kind": "componentKind",
          "component-type": "componentType", "activity-type": "activityType", "execution-type": "executionType"}  # fmt: skip


def list_values(package: Package, key: str) -> list[str]:
    """@param key one of KEYS."""
    view = package.view
    interfaces = [part for port in view.service_ports for part in port.list_parts("ServiceInterface")]
    match key:
        case "id":
            return [package.id]
        case "language":
            return [view.language]
        case "port":
            return [part.name for part in [*view.data_ports, *view.service_ports]]
        case "data-type":
            return [part.get_value("type") for part in view.data_ports]
        case "service":
            return [part.name for part in interfaces]
        case "service-type":
            return [part.get_value("type") for part in interfaces]
        case "parameter":
            return [part.name for part in view.configurations]
        case _:
            return [view.basic.get_value(_BASIC[key])]


def find_packages(folder: Path) -> tuple[list[Package], list[str]]:
    """@return the packages below `folder` by path, and one message for each RTC.xml that cannot be used. @raise InputError without a folder."""
    if not folder.is_dir():
        raise InputError("not a folder; specify the folder of the component packages", folder)
    packages, errors = [], []
    for path in _list_files(folder):
        try:
            with path.open("rb") as file:
                if not ROOT.match(file.read(MAX_BYTES).replace(b"\0", b"")):  # also in UTF-16
                    continue
            profile = load_profile(path, tolerant=True)
        except (InputError, OSError) as error:
            errors.append(str(error))
            continue
        if profile.family != "rtc":
            continue
        if profile.violations:
            errors.append(f"{path}:{profile.violations[0].line}: {profile.violations[0].text}")
        else:
            packages.append(Package(path, profile, RtcView(profile.root, profile.table)))
    return packages, errors


def _list_files(folder: Path) -> list[Path]:
    found = []
    for path in folder.rglob("*"):
        if path.suffix.lower() == ".xml" and path.is_file() and not any(HIDDEN.fullmatch(part) for part in path.relative_to(folder).parts[:-1]):
            found.append(path)
        if len(found) > FILES_MAX:
            raise InputError(f"more than {FILES_MAX} XML files; specify a smaller folder", folder)
    return sorted(found)


def select(packages: list[Package], criteria: Sequence[tuple[str, str]]) -> list[Package]:
    """The packages that match each pattern (with * and ?, case ignored). @raise InputError for a key that is not in KEYS."""
    for key, _ in criteria:
        if key not in KEYS:
            raise InputError(f"profile find: there is no key '{key}'; {nearest_names(key, KEYS)}")
    return [package for package in packages if all(
        any(fnmatch.fnmatchcase(value.lower(), pattern.lower()) for value in list_values(package, key)) for key, pattern in criteria)]  # fmt: skip


def resolve_components(system: Profile, packages: list[Package]) -> dict[str, Package]:
    """@param system a valid RTS profile. @return the package of each instance, by its name.
    @raise InputError with file and line for an instance of a name that occurred before, or an id without or with several packages."""
    by_id: dict[str, list[Package]] = {}
    for package in packages:
        for id_ in dict.fromkeys(package.ids):
            by_id.setdefault(id_, []).append(package)
    found: dict[str, Package] = {}
    for component in RtsView(system.root, system.table).components:
        id_, instance = component.get_value("id"), component.get_value("instanceName")
        own = by_id.get(id_, [])
        if instance in found:
            raise InputError(f"the instance {instance} occurs more than once; rename one", system.path, component.line)
        if not own:
            raise InputError(f"no package has the id {id_} of {instance}; {nearest_names(id_, by_id, 'add its package')}", system.path, component.line)
        if len(own) > 1:
            raise InputError(f"{len(own)} packages have the id {id_} of {instance}: {own[0].path}, {own[1].path}; remove one", system.path, component.line)
        found[instance] = own[0]
    return found
