# SPDX-License-Identifier: Apache-2.0
"""All paths that the command reads or writes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]

RELEASE = "host-release"
SANITIZED = "host-asan"
LONG_LABEL = "long"
"""CTest's label of a test that only runs the compiler, or that tries so many cases or instructions that it takes minutes with sanitizers.
Shorter tests of the same code run with sanitizers."""
CPP_SUFFIXES = (".hpp", ".cpp", ".h", ".c")
CPP_LAYERS = ("kernel", "safety", "ports", "simbody_sim", "examples", "tools", "trace", "verification")
CHECKED_LAYERS = ("kernel", "safety", "ports")


@dataclass(frozen=True)
class Project:
    """A source tree and the folders to which its runs write. `preset` names the build whose evidence counts."""

    root: Path
    preset: str = RELEASE

    @property
    def build(self) -> Path:
        return self.root / "build" / self.preset

    @property
    def evidence(self) -> Path:
        return self.build / "evidence"

    @property
    def junit(self) -> Path:
        return self.evidence / "junit"

    @property
    def logs(self) -> Path:
        return self.root / "build" / "log"

    @property
    def report(self) -> Path:
        return self.root / "report" / "index.html"

    @property
    def safe_arm(self) -> Path:
        """The program of the example."""
        return self.build / "examples" / "safe_arm" / "safe_arm"

    @property
    def model(self) -> Path:
        """The arm of the example."""
        return self.root / "simbody_sim" / "models" / "pa10_like.yaml"

    @property
    def motion(self) -> Path:
        """The shipped motion."""
        return self.root / "examples" / "safe_arm" / "motions" / "pick_and_place.yaml"

    @property
    def campaign_plan(self) -> Path:
        """The injected faults and their expected results."""
        return self.root / "examples" / "safe_arm" / "faults.yaml"

    def cpp_sources(self, layers: tuple[str, ...] = CPP_LAYERS) -> list[str]:
        """C++ and C files of `layers`, relative to the root, sorted."""
        return sorted(
            str(path.relative_to(self.root))
            for layer in layers
            for path in (self.root / layer).rglob("*")
            if path.suffix in CPP_SUFFIXES
        )
