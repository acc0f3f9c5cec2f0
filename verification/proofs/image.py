# SPDX-License-Identifier: Apache-2.0
"""The small but complete system of verification/proofs/target: its sources, its linking, and its run in QEMU.

@satisfies SWR-PRF-024, SWR-PRF-027, SWR-PRF-028      Design: docs/design/proofs.md#watermark
"""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import WorkError
from verification.proofs.target_layers import find_target_layers
from verification.proofs.toolchain import CORTEX_M4, Toolchain, Unit, run_tool

TARGET = Path("verification/proofs/target")
PORT = Path("ports/virtual_time")
EXAMPLE = Path("examples/safe_arm")
LINKER_SCRIPT = TARGET / "mps2_an386.ld"
RUN_TIMEOUT_S = 60
BOARD = {CORTEX_M4.name: {"startup", "board_mps2"}}
INCLUDE = re.compile(r'^#include "([\w/]+)\.hpp"', re.MULTILINE)
QEMU = ("qemu-system-arm", "-machine", "mps2-an386", "-display", "none", "-monitor", "none", "-serial", "none",
        "-semihosting-config", "enable=on,target=native", "-kernel")  # fmt: skip


@dataclass(frozen=True)
class Run:
    """Complete output of the image."""

    frames: int
    overruns: int
    latched_faults: int
    operational_frames: int
    trace_hash: int
    stack_used_bytes: int


def find_sources(root: Path, toolchain: Toolchain) -> list[str]:
    """Sources of the image for one processor: target layers, port, its own sources, and the included sources of the example."""
    board = BOARD.get(toolchain.name, {"board_host"})
    boards = {"board_host"}.union(*BOARD.values())
    own = [path for path in sorted((root / TARGET).glob("*.cpp")) if path.stem in board or path.stem not in boards]
    wanted = _list_included(sorted((root / TARGET).glob("*.?pp")))
    while (more := wanted | _list_included(path for name in wanted for path in (root / EXAMPLE).glob(f"{name}.?pp"))) != wanted:
        wanted = more
    example = [path for path in sorted((root / EXAMPLE).glob("*.cpp")) if path.stem in wanted]
    layers = [path for layer in find_target_layers(root) for path in layer.sources()]
    paths = [*layers, *sorted((root / PORT / "src").glob("*.cpp")), *example, *own]
    return list(dict.fromkeys(str(path.relative_to(root)) for path in paths))


def _list_included(paths: Iterable[Path]) -> set[str]:
    """Stems of the headers that the files include by name."""
    return {name for path in paths if path.exists() for name in INCLUDE.findall(path.read_text(encoding="utf-8"))}


def find_includes(root: Path) -> list[str]:
    """Folders with the headers of those sources."""
    layers = [str(layer.include.relative_to(root)) for layer in find_target_layers(root)]
    return list(dict.fromkeys([*layers, str(PORT / "include"), str(EXAMPLE), str(TARGET)]))


def link_image(root: Path, units: Sequence[Unit], result: Path, toolchain: Toolchain = CORTEX_M4) -> Path:
    """@return `result`, the image. @raise WorkError"""
    bare = ("-nostdlib", "-nostartfiles", "-T", str(root / LINKER_SCRIPT), "-Wl,--gc-sections", "-lc", "-lgcc")
    machine = bare if toolchain is CORTEX_M4 else ("-no-pie",)
    run_tool([toolchain.compiler, *toolchain.flags, *(str(unit.object) for unit in units), *machine, "-o", str(result)])
    return result


def get_stack_size(image: Path) -> int:
    """Size of the stack in the linker script [bytes]."""
    lines = run_tool([f"{CORTEX_M4.prefix}nm", "--format=posix", str(image)]).splitlines()
    values = {line.split(" ")[0]: int(line.split(" ")[2], 16) for line in lines}
    return values["stack_top"] - values["stack_bottom"]


def check_watermark(bound: int | None, used: int) -> str:
    """@return the contradiction between a proven bound and the stack that a run used [bytes]; empty if they agree."""
    if bound is None:
        return "the program has no bound; see the findings of the stack proof"
    if used <= 0:
        return "the image measured no stack at all; is it painted?"
    if used > bound:
        return f"the run used {used} bytes of stack, {used - bound} more than the proven bound of {bound}; the proof is wrong"
    return ""


def run_in_qemu(image: Path) -> Run:
    """@raise WorkError if the run did not end by itself with a complete record."""
    return _run([*QEMU, str(image)])


def run_on_host(image: Path) -> Run:
    """@raise WorkError if the run did not end by itself with a complete record."""
    return _run([str(image)])


def _run(argv: Sequence[str]) -> Run:
    try:
        done = subprocess.run(argv, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL,
                              timeout=RUN_TIMEOUT_S)  # fmt: skip
    except FileNotFoundError as error:
        raise WorkError(f"{argv[0]} is missing; ./mamori test installs it") from error
    except subprocess.TimeoutExpired as error:
        raise WorkError(f"{argv[-1]} did not end within {RUN_TIMEOUT_S} s") from error
    # The exit status alone is not sufficient: a processor that resets or is powered off also ends with 0.
    if done.returncode != 0:
        raise WorkError(f"{argv[-1]} ended with status {done.returncode}: {done.stderr.strip()}")
    try:
        return Run(**json.loads(done.stderr))
    except (ValueError, TypeError) as error:
        raise WorkError(f"{argv[-1]} told no whole record: '{done.stderr.strip()}'") from error
