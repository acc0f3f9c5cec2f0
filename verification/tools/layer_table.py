# SPDX-License-Identifier: Apache-2.0
"""The layer table of CONTRIBUTING.md as data.

@satisfies SWR-PRF-006      Design: docs/design/launcher.md#layer-check
"""

from __future__ import annotations

from dataclasses import dataclass

# A new name needs an ADR.
LISTED_STD = frozenset("array atomic cstddef cstdint limits new type_traits utility".split())
TEST_INCLUDES = ("mamori/verification/verifies.hpp", "mamori/verification/failed_check.hpp", "gtest/", "gmock/")
PORT_TEST_INCLUDES = ("mamori/ports/conformance/",)  # the rules that each port must pass: ADR 0012
SIMULATION_INCLUDES = ("Simbody.h", "SimTK", "simbody/", "simmath/", "kdl/", "Eigen/", "yaml-cpp/")


@dataclass(frozen=True)
class Layer:
    """What one layer may include and link. Prefixes: `mamori/` ones name headers of the project."""

    name: str
    headers: tuple[str, ...]  # prefixes of include paths
    links: tuple[str, ...]  # layers
    any_std: bool = True
    any_library: bool = False  # an OS or library of its own, to be named in the folder's CMakeLists.txt
    test_headers: tuple[str, ...] = ()  # prefixes of include paths, in its tests
    target: bool = False  # runs on a controller: limits of size and words hold


def get_layer(path: tuple[str, ...]) -> Layer | None:
    """The row for the file `path` (parts relative to the root); None where the table has no row."""
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
        case ("examples" | "verification", *_):
            return Layer(path[0], ("mamori/",), (), any_library=True)
        case _:
            return None


_TRACE_UPPER = ("mamori.trace.checks", "mamori.trace.reports", "mamori.trace.actions", "mamori.trace.command")

# Folder of Python -> packages of ours that must not be imported in or below it.
FORBIDDEN_IMPORTS = {
    "trace": ("mamori.profiles", "mamori.verification"),
    "trace/model": ("mamori.trace.readers", "mamori.trace.formats", *_TRACE_UPPER),
    "trace/readers": ("mamori.trace.formats", *_TRACE_UPPER),
    "trace/formats": _TRACE_UPPER,
    "trace/checks": ("mamori.trace.formats", *_TRACE_UPPER[1:]),
    "trace/reports": ("mamori.trace.formats", *_TRACE_UPPER[2:]),
    "profiles": ("mamori.trace", "mamori.verification"),
}

# Exceptions: there is one way to write a file, and both products use it.
ALLOWED_IMPORTS = {"profiles": ("mamori.trace.whole_file.",)}
