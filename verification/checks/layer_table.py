# SPDX-License-Identifier: Apache-2.0
"""The layer table of CONTRIBUTING.md as data.

@satisfies SWR-PRF-006      Design: docs/design/launcher.md#layer-check
"""

from __future__ import annotations

from dataclasses import dataclass

# A new name needs an ADR.
LISTED_STD = frozenset("array atomic cstddef cstdint limits new type_traits utility".split())
LISTED_C = frozenset("stdbool.h stdint.h".split())  # for headers in C: ADR 0062
# Kernel sources that use POSIX headers on a host, inside "#if defined(__unix__)": ADR 0034.
HOST_SOURCES = frozenset({"kernel/src/base/assert.cpp"})
TEST_INCLUDES = ("mamori/trace/verifies.hpp", "mamori/verification/failed_check.hpp", "gtest/", "gmock/", "relacy/")
PORT_TEST_INCLUDES = ("mamori/ports/conformance/",)  # the rules for each port: ADR 0012
SIMULATION_INCLUDES = ("Simbody.h", "SimTK", "simbody/", "simmath/", "kdl/", "Eigen/", "yaml-cpp/")


@dataclass(frozen=True)
class Layer:
    """Permitted includes and links of one layer. Prefixes that begin with `mamori/` name project headers."""

    name: str
    headers: tuple[str, ...]  # prefixes of include paths
    links: tuple[str, ...]  # layers
    any_std: bool = True
    any_library: bool = False  # an operating system or a separate library, named in the CMakeLists.txt of the folder
    test_headers: tuple[str, ...] = ()  # prefixes of include paths that only its tests may use
    target: bool = False  # runs on a controller: limits for sizes and words apply


def get_layer(path: tuple[str, ...]) -> Layer | None:
    """The row for the file `path` (parts relative to the root); None if the table has no row."""
    match path:
        case ("kernel", *_):
            return Layer("kernel", ("mamori/kernel/",), (), any_std=False, target=True)
        case ("safety", *inner):
            arm = ("Eigen/",) if "arm" in inner else ()
            return Layer("safety", ("mamori/kernel/", "mamori/safety/", *arm), ("kernel",), any_std=False, target=True)
        case ("ports", port, *_):
            own = (f"mamori/{port}/", f"mamori/ports/{port}/")
            return Layer(f"ports/{port}", ("mamori/kernel/", "mamori/safety/", *own), ("kernel", "safety"),
                         any_library=True, test_headers=PORT_TEST_INCLUDES, target=True)
        case ("simbody_sim", *_):
            below = ("kernel", "safety", "virtual_time")
            own = ("mamori/simbody_sim/", "mamori/ports/virtual_time/")
            return Layer("simbody_sim", (*(f"mamori/{name}/" for name in below), *own, *SIMULATION_INCLUDES), below)
        case ("tools", "probe", *_):
            headers = ("mamori/kernel/", "mamori/safety/", "mamori/ports/", "mamori/table_dump/", "mamori/timing/")
            return Layer("tools/probe", headers, ("kernel", "safety", "posix_rt", "virtual_time", "table_dump", "timing"), any_library=True)
        case ("trace", "include", *_):
            return Layer("trace", ("gtest/",), ())
        case ("examples" | "verification", *_):
            return Layer(path[0], ("mamori/",), (), any_library=True)
        case _:
            return None


# Python package -> level. A file may import its own package and packages of lower levels; the import path is the folder path. The packages
# of `mamori_trace` are a separate product: they are below all other packages and import none of them.
PACKAGE_LEVELS = {
    "mamori_trace.base": 0, "mamori_trace.cache": 1, "mamori_trace.model": 1, "mamori_trace.readers": 2, "mamori_trace.checks": 3,
    "mamori_trace.formats": 3, "mamori_trace.reports": 4, "mamori_trace.actions": 5, "mamori_trace": 6,
    "mamori_tools.host": 7, "mamori_tools.motion": 7, "mamori_tools.profiles": 7, "mamori_tools.table": 8, "mamori_tools.e2e": 8,
    "mamori_tools.lcm": 8, "mamori_tools.campaign": 8, "mamori_tools.log": 9, "mamori_tools.timing": 9, "mamori_tools.hil": 9,
    "mamori_tools.cost": 10, "mamori_tools.command": 11,
    "verification.checks": 12, "verification.faults": 12,
}  # fmt: skip
PACKAGE_FOLDERS = {"trace/mamori_trace": "mamori_trace", "tools/mamori_tools": "mamori_tools", "verification": "verification"}


TOP_LEVEL = 13  # of the packages of `verification` without a row


def find_package(module: str) -> tuple[str, int] | None:
    """@return package and level of a module or of an import from a module; None for external code. @raise KeyError for a package of the
    tools without a row."""
    parts = [part for part in module.split(".") if part != "__init__"]
    name = ".".join(parts[:2])
    if name in PACKAGE_LEVELS:
        return name, PACKAGE_LEVELS[name]
    match parts[0]:
        case "mamori_trace":  # its top-level modules
            return parts[0], PACKAGE_LEVELS[parts[0]]
        case "mamori_tools" if len(parts) == 1:
            return parts[0], 0
        case "mamori_tools":
            raise KeyError(name)
        case "verification":
            return name, TOP_LEVEL
        case _:
            return None


def get_module(path: tuple[str, ...]) -> str | None:
    """@return the dotted name of a Python file of the packages; None for other files, including tests."""
    name = "/".join(path)
    if "tests" in path or path[-1].startswith(("test_", "conftest")):
        return None
    for folder, package in PACKAGE_FOLDERS.items():
        if name.startswith(f"{folder}/"):
            return ".".join([package, *name.removeprefix(f"{folder}/").removesuffix(".py").split("/")])
    return None
