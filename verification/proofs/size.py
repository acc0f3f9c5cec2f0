# SPDX-License-Identifier: Apache-2.0
"""Memory of small systems on a Cortex-M4: links the images of size/image.cpp and compares their sizes with size.toml.

    python -P -m verification.proofs.size [--out FOLDER]

prints the table and, with --out, writes size.json and size.txt there. Exit status 1 if a limit is exceeded.

@satisfies SWR-VER-031      Design: docs/design/proofs.md#size
"""

from __future__ import annotations

import argparse
import json
import os
import re
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path

from mamori_tools.host.project import ROOT
from mamori_trace.base.errors import WorkError
from mamori_trace.base.text_file import write_text
from verification.proofs.image import LINKER_SCRIPT, TARGET
from verification.proofs.toolchain import CORTEX_M4, SUBSET, run_tool

LIMITS = Path(__file__).with_suffix(".toml")
SCHEMA = "mamori.size/1"
IMAGE = Path("verification/proofs/size/image.cpp")
INCLUDES = (Path("kernel/include"), Path("safety/include"), TARGET)
BASE = "two"
SOURCES = ("kernel/src/*/*.cpp", "safety/src/e2e/*.cpp", "safety/src/supervision/*.cpp")
BOARD = ("startup", "board_mps2")
WIDTHS = (17, 8, 8, 8, 8, 8, 8, 13, 7, 9)  # of the columns of the table
TEXT = (".text", ".ARM.exidx")
RAM = (".data", ".bss")
ROW = re.compile(r" (?:\.\S+|\*fill\*)\s+0x([0-9a-f]+)\s+0x([0-9a-f]+)(?: (\S+))?\s*$")


@dataclass(frozen=True)
class Limits:
    """The maximum size of one image [bytes], and its aims."""

    name: str
    title: str
    text_max: int
    ram_max: int
    macro: str = ""
    text_aim: int | None = None
    ram_aim: int | None = None
    missed: bool = False


@dataclass(frozen=True)
class Size:
    """The size of one image [bytes]. RAM excludes stacks; `data` are initial values, which also occupy flash memory."""

    text: int
    ram: int
    data: int
    parts: dict[str, int] = field(default_factory=dict)  # text by origin: kernel, safety, application, board, library


def read_limits(path: Path = LIMITS) -> list[Limits]:
    """The rows of the limits, in the order of the file."""
    return [Limits(**row) for row in tomllib.loads(path.read_text(encoding="utf-8"))["image"]]


def measure(rows: Sequence[Limits], root: Path, folder: Path) -> dict[str, Size]:
    """Links the image of each row in `folder` as NAME.elf, names without spaces. @raise WorkError"""
    sources = [path for pattern in SOURCES for path in sorted(root.glob(pattern))]
    names = [str(path.relative_to(root)) for path in (*sources, *(root / TARGET / f"{name}.cpp" for name in BOARD))]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(lambda name: _compile(root, name, folder / (name.replace("/", "_") + ".o")), names))
        sizes = pool.map(lambda row: _link(root, row, objects, folder), rows)
        return {row.name: size for row, size in zip(rows, sizes, strict=True)}


def list_findings(limits: Limits, size: Size) -> list[str]:
    """@return findings: empty if the size is within its limits and each aim is met or marked as missed."""
    findings = [f"{what} takes {value} bytes, {value - most} more than its limit of {most}"
                for what, value, most in (("text", size.text, limits.text_max), ("RAM", size.ram, limits.ram_max)) if value > most]  # fmt: skip
    missed = [f"{what} takes {value} bytes, more than the aim of {aim}"
              for what, value, aim in (("text", size.text, limits.text_aim), ("RAM", size.ram, limits.ram_aim))
              if aim is not None and value > aim]  # fmt: skip
    if limits.missed and not missed:
        findings.append(f"every aim is met; remove the mark `missed` in {LIMITS.name}")
    return findings + ([] if limits.missed else missed)


def make_table(rows: Sequence[Limits], sizes: dict[str, Size]) -> str:
    """The table of all images, each with its difference from the base."""
    base = sizes[BASE]
    lines = ["image                text    more     RAM    more  kernel  safety  application  board  library"]
    for row in rows:
        size = sizes[row.name]
        parts = (size.parts.get(name, 0) for name in ("kernel", "safety", "application", "board", "library"))
        cells = (f"{row.name:17}", size.text, f"{size.text - base.text:+}", size.ram, f"{size.ram - base.ram:+}", *parts)
        lines.append("".join(f"{cell:>{width}}" for cell, width in zip(cells, WIDTHS, strict=True)))
        aims = [f"{what} {aim} {'missed' if value > aim else 'met'}"
                for what, value, aim in (("text", size.text, row.text_aim), ("RAM", size.ram, row.ram_aim)) if aim is not None]  # fmt: skip
        if aims:
            lines.append(f"  aim: {', '.join(aims)}")
    return "\n".join([*lines, ""])


def write_evidence(rows: Sequence[Limits], sizes: dict[str, Size], folder: Path) -> None:
    """Writes size.json and size.txt, each atomically."""
    folder.mkdir(parents=True, exist_ok=True)
    compiler = run_tool([CORTEX_M4.compiler, "--version"]).splitlines()[0]
    images = [{**asdict(row), **asdict(sizes[row.name]), "findings": list_findings(row, sizes[row.name])} for row in rows]
    record = {"schema": SCHEMA, "compiler": f"{compiler} {' '.join(CORTEX_M4.flags)}", "base": BASE, "images": images}
    write_text(folder / "size.json", json.dumps(record, indent=1) + "\n")
    write_text(folder / "size.txt", make_table(rows, sizes))


def read_map(text: str) -> Iterator[tuple[str, str, int]]:
    """Output section, object file and size of each linked input section of a linker map. An empty object file means padding.

    The linker merges equal texts and lists them at the address of the text that it keeps. Only the addresses therefore show the sizes.
    """
    text = re.sub(r"\n( \.\S+)\n +0x", r"\n\1 0x", text[text.index("Linker script and memory map") :])
    section = ""
    rows: list[tuple[str, str, int, int]] = []
    for line in text.splitlines():
        if re.match(r"\.\S", line):
            section = line.split()[0]
        row = ROW.match(line)
        if row is not None:
            rows.append((section, row[3] or "", int(row[1], 16), int(row[2], 16)))
    for (section, origin, begin, size), following in zip(rows, [*rows[1:], None], strict=True):
        yield section, origin, min(size, following[2] - begin) if following is not None and following[0] == section else size


def _compile(root: Path, source: str, result: Path, *options: str) -> Path:
    includes = (f"-I{path}" for path in INCLUDES)
    run_tool([CORTEX_M4.compiler, *SUBSET, *CORTEX_M4.flags, *options, *includes, "-c", source, "-o", str(result)], cwd=root)
    return result


def _link(root: Path, row: Limits, objects: Sequence[Path], folder: Path) -> Size:
    stem = folder / row.name.replace(" ", "_")
    image, link_map = stem.with_suffix(".elf"), stem.with_suffix(".map")
    own = _compile(root, str(IMAGE), stem.with_suffix(".o"), *([f"-D{row.macro}"] if row.macro else []))
    run_tool([CORTEX_M4.compiler, *CORTEX_M4.flags, str(own), *map(str, objects), "-nostdlib", "-nostartfiles", "-T",
              str(root / LINKER_SCRIPT), "-Wl,--gc-sections", f"-Wl,-Map={link_map}", "-lc", "-lgcc", "-o", str(image)])  # fmt: skip
    lines = run_tool([f"{CORTEX_M4.prefix}size", "-A", str(image)]).splitlines()
    sections = {cells[0]: int(cells[1]) for cells in map(str.split, lines) if cells and cells[0] in (*TEXT, *RAM)}
    parts: Counter[str] = Counter()
    for section, origin, size in read_map(link_map.read_text(encoding="utf-8")):
        if section in TEXT:
            parts[_name_part(Path(origin).name, own.name)] += size
    return Size(
        text=sum(sections.get(name, 0) for name in TEXT),
        ram=sum(sections.get(name, 0) for name in RAM),
        data=sections.get(".data", 0),
        parts=dict(sorted(parts.items())),
    )


def _name_part(origin: str, own: str) -> str:
    if origin.startswith("lib"):
        return "library"
    if origin.startswith("verification_"):
        return "board"
    return "application" if origin in ("", own) else origin.partition("_")[0]


def main(argv: list[str] | None = None) -> int:
    """Prints the table. @return the exit status."""
    parser = argparse.ArgumentParser(description="Memory of small systems on a Cortex-M4.", allow_abbrev=False)
    parser.add_argument("--out", type=Path, help="folder for size.json and size.txt")
    out = parser.parse_args(argv).out
    rows = read_limits()
    try:
        with tempfile.TemporaryDirectory() as folder:
            sizes = measure(rows, ROOT, Path(folder))
        if out is not None:
            write_evidence(rows, sizes, out)
    except WorkError as error:
        print(f"size: {error}", file=sys.stderr)
        return 1
    print(make_table(rows, sizes), end="")
    findings = [f"{row.name}: {finding}" for row in rows for finding in list_findings(row, sizes[row.name])]
    print("\n".join(findings), file=sys.stderr, end="\n" if findings else "")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
