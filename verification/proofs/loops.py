# SPDX-License-Identifier: Apache-2.0
"""Every loop of the target layers terminates: its form shows the bound, or `loops.toml` gives it with a reason. No goto.

    python -P -m verification.proofs.loops [--root FOLDER]

prints one line per finding, `file:line: rule: message`; exit status 1 with findings.

@satisfies SWR-PRF-025, SWR-PRF-026      Design: docs/design/proofs.md#loops
"""

from __future__ import annotations

import argparse
import re
import sys
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tree_sitter import Node, Parser

from mamori_tools.host.project import ROOT
from verification.checks.target_limits import COMMENT_OR_TEXT, LANGUAGE
from verification.proofs.target_layers import find_target_layers

RULES = Path(__file__).with_name("loops.toml")
KEYWORD = re.compile(r"\b(?:for|while|do|goto)\b")
LOOPS = {"for_statement": "for", "for_range_loop": "range", "while_statement": "while", "do_statement": "do"}
MORE_THAN_ZERO = re.compile(r"0[uUlL]*")
STEP = re.compile(r"[1-9][0-9']*[uUlL]*")
NARROW = re.compile(r"\b(?:u?int(?:8|16)_t|char|short|bool|auto)\b")  # may wrap before they reach a bound of another type


@dataclass(frozen=True)
class Loop:
    """One loop in the source."""

    file: str
    line: int
    function: str  # with its classes, without namespaces
    kind: str  # range, counted, for, while, do
    condition: str  # white space is one space each

    @property
    def is_bounded(self) -> bool:
        """The form of the loop shows that it terminates."""
        return self.kind in ("range", "counted")


@dataclass(frozen=True)
class LoopRow:
    """A reviewed loop of another form."""

    file: str
    function: str
    condition: str
    bound: str
    reason: str


@dataclass(frozen=True, order=True)
class LoopFinding:
    """A loop that may not terminate, or a row that matches no loop."""

    file: str
    line: int
    rule: str
    message: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.rule}: {self.message}"


def read_rows(path: Path = RULES) -> list[LoopRow]:
    """The checked list."""
    return [LoopRow(**row) for row in tomllib.loads(path.read_text(encoding="utf-8")).get("loop", ())]


def find_files(root: Path) -> list[Path]:
    """Sources and headers of the layers that run on a controller."""
    folders = [folder for layer in find_target_layers(root) for folder in (layer.folder / "include", layer.folder / "src")]
    return sorted(path for folder in folders for path in folder.rglob("*") if path.suffix in (".hpp", ".cpp"))


def find_loops(root: Path, files: Sequence[Path]) -> tuple[list[Loop], list[LoopFinding]]:
    """All loops of `files`, and forbidden code: a goto, or a loop in a macro."""
    loops: list[Loop] = []
    findings: list[LoopFinding] = []
    for path in files:
        name = str(path.relative_to(root))
        text = path.read_text(encoding="utf-8")
        seen = set()
        for node in _walk(Parser(LANGUAGE).parse(text.encode("utf-8")).root_node):
            line = node.start_point.row + 1
            if node.type in LOOPS:
                loops.append(_make_loop(name, node))
            elif node.type == "goto_statement":
                findings.append(LoopFinding(name, line, "goto", f"{_get_function(node)} jumps; write a loop or a function"))
            elif KEYWORD.fullmatch(node.type):
                seen.add((line, node.start_point.column))
        findings += [LoopFinding(name, line, "loop", f"'{word}' is no loop that can be judged: in a macro, or not understood; "
                                 "write it as a loop of a function") for line, column, word in _find_keywords(text)
                     if (line, column) not in seen]  # fmt: skip
    return loops, findings


def check_loops(loops: Sequence[Loop], rows: Sequence[LoopRow]) -> list[LoopFinding]:
    """Loops without a bound from their form or from exactly one row, and rows that do not match exactly one loop."""
    findings = []
    for loop in loops:
        if not loop.is_bounded and not any(_does_match(row, loop) for row in rows):
            findings.append(LoopFinding(loop.file, loop.line, "loop", f"{loop.function}: the form of '{loop.condition}' shows no "
                            f"bound; count up to one in a for loop, or give it a row in {RULES.name}"))  # fmt: skip
    for row in rows:
        lines = [loop.line for loop in loops if _does_match(row, loop) and not loop.is_bounded]
        if len(lines) != 1:
            what = f"lines {', '.join(map(str, lines))} have" if lines else "no loop of unknown bound has"
            findings.append(LoopFinding(row.file, lines[0] if lines else 1, "loop" if lines else "unused row",
                            f"{what} the condition '{row.condition}' in {row.function} that {RULES.name} lists; "
                            "a row is for one loop"))  # fmt: skip
    return findings


def make_record(loops: Sequence[Loop], rows: Sequence[LoopRow], findings: Sequence[LoopFinding]) -> dict[str, object]:
    """The evidence."""
    counts = {kind: sum(loop.kind == kind for loop in loops) for kind in ("range", "counted")}
    return {"loops": len(loops), **counts, "listed": [vars(row) for row in rows],
            "findings": [str(finding) for finding in findings]}  # fmt: skip


def _does_match(row: LoopRow, loop: Loop) -> bool:
    return (row.file, row.function, row.condition) == (loop.file, loop.function, loop.condition)


def _walk(root: Node) -> Iterator[Node]:
    pending = [root]
    while pending:
        node = pending.pop()
        yield node
        pending.extend(reversed(node.children))


def _find_keywords(text: str) -> Iterator[tuple[int, int, str]]:
    """Every keyword that begins a loop, as (line, column in bytes, word), found without the grammar."""
    code = COMMENT_OR_TEXT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    for number, (line, original) in enumerate(zip(code.split("\n"), text.split("\n"), strict=True), start=1):
        for match in KEYWORD.finditer(line):
            yield number, len(original[: match.start()].encode("utf-8")), match[0]


def _make_loop(file: str, node: Node) -> Loop:
    kind = LOOPS[node.type]
    if kind == "for":
        parts = [_get_text(node.child_by_field_name(name)).removesuffix(";") for name in ("initializer", "condition", "update")]
        condition = "; ".join(parts)
        kind = "counted" if _is_counted(node) else kind
    elif kind == "range":
        condition = _get_text(node.child_by_field_name("right"))
    else:
        condition = re.sub(r"^\((.*)\)$", r"\1", _get_text(node.child_by_field_name("condition")))
    return Loop(file, node.start_point.row + 1, _get_function(node), kind, condition)


def _is_counted(node: Node) -> bool:
    """One counter with constant steps towards a bound; the body changes neither counter nor bound."""
    counter = _get_counter(node.child_by_field_name("initializer"))
    condition, update, body = (node.child_by_field_name(name) for name in ("condition", "update", "body"))
    if not counter or condition is None or body is None:
        return False
    for part in _split_conjunction(condition):
        if part.type != "binary_expression":
            continue
        left, right = part.child_by_field_name("left"), part.child_by_field_name("right")
        operator = _get_text(part.child_by_field_name("operator"))
        counts_up = operator == "<" and _is_counter(left, counter) and _is_step(update, counter, "++", "+=")
        counts_down = (operator == ">" and MORE_THAN_ZERO.fullmatch(_get_text(right)) is not None
                       and ((_get_text(left) == f"{counter}--" and update is None)
                            or (_get_text(left) == counter and _is_step(update, counter, "--"))))  # fmt: skip
        if (counts_up or counts_down) and not _find_changed(body) & {counter, *_find_names(right)}:
            return True
    return False


def _get_counter(initializer: Node | None) -> str:
    """Name of the only variable that the loop declares with an initial value. Its type is wide enough for any count."""
    if initializer is None or initializer.type != "declaration":
        return ""
    if NARROW.search(_get_text(initializer.child_by_field_name("type"))):
        return ""
    declarators = initializer.children_by_field_name("declarator")
    if len(declarators) != 1 or declarators[0].type != "init_declarator":
        return ""
    name = declarators[0].child_by_field_name("declarator")
    return _get_text(name) if name is not None and name.type == "identifier" else ""


def _split_conjunction(node: Node) -> Iterator[Node]:
    if node.type == "binary_expression" and _get_text(node.child_by_field_name("operator")) == "&&":
        for name in ("left", "right"):
            child = node.child_by_field_name(name)
            if child is not None:
                yield from _split_conjunction(child)
    else:
        yield node


def _is_counter(node: Node | None, counter: str) -> bool:
    """The counter, or the counter plus a constant."""
    text = _get_text(node)
    more = text.removeprefix(f"{counter} + ")
    return text == counter or (more != text and STEP.fullmatch(more) is not None)


def _is_step(update: Node | None, counter: str, one: str, many: str = "") -> bool:
    """One step or, if `many` permits it, a constant number of steps."""
    text = _get_text(update)
    step = text.removeprefix(f"{counter} {many} ")
    return text in (f"{one}{counter}", f"{counter}{one}") or (step != text and STEP.fullmatch(step) is not None)


def _find_names(node: Node | None) -> set[str]:
    """Variables and members that an expression reads."""
    return {_get_text(part) for part in (_walk(node) if node else ()) if part.type in ("identifier", "field_expression")}


def _find_changed(body: Node) -> set[str]:
    """Variables and members that are assigned, incremented or decremented, or whose address is taken."""
    changed = set()
    for node in _walk(body):
        if node.type == "assignment_expression":
            changed.add(_get_text(node.child_by_field_name("left")))
        elif node.type == "update_expression" or (node.type == "pointer_expression" and _get_text(node).startswith("&")):
            changed.add(_get_text(node.child_by_field_name("argument")))
    return changed


def _get_function(node: Node) -> str:
    """Name of the function that contains a node, with its classes."""
    names: list[str] = []
    place: Node | None = node
    while place is not None:
        if place.type == "function_definition" and not names:
            names.append(_get_text(_get_name_node(place)))
        elif place.type in ("class_specifier", "struct_specifier") and names:
            names.append(_get_text(place.child_by_field_name("name")))
        place = place.parent
    return "::".join(reversed(names)) or "no function"


def _get_name_node(function: Node) -> Node | None:
    node = function.child_by_field_name("declarator")
    while node is not None and node.type != "function_declarator":
        node = node.child_by_field_name("declarator") or next(
            (child for child in node.children if child.type.endswith("declarator")), None)  # fmt: skip
    return node.child_by_field_name("declarator") if node is not None else None


def _get_text(node: Node | None) -> str:
    return " ".join(node.text.decode("utf-8").split()) if node is not None and node.text else ""


def main(argv: list[str] | None = None) -> int:
    """Prints the findings. @return the exit status."""
    parser = argparse.ArgumentParser(description="Bounds of all loops in the target layers.", allow_abbrev=False)
    parser.add_argument("--root", type=Path, default=ROOT, help="source tree to check; default: this project")
    root = parser.parse_args(argv).root
    if not (root / "kernel").is_dir():
        parser.error(f"'{root}' has no folder kernel; give the root of the source tree")
    loops, findings = find_loops(root, find_files(root))
    findings += check_loops(loops, read_rows())
    for finding in sorted(findings):
        print(finding)
    listed = sum(not loop.is_bounded for loop in loops)
    print(f"loop proof: {len(loops)} loops, {len(loops) - listed} bounded by their form, {listed} others, "
          f"{len(findings)} findings")  # fmt: skip
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
