# SPDX-License-Identifier: Apache-2.0
"""Creates mutants of a C++ source: one small change each. Changes are made in the syntax tree, so that most mutants compile.

The same text gives the same mutants in the same order. A change never adds or removes a line.

@satisfies SWR-VER-004      Design: docs/design/test_strength.md#operators
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator
from dataclasses import dataclass

import tree_sitter_cpp
from tree_sitter import Language, Node, Parser

from verification.mutation import wiring

LANGUAGE = Language(tree_sitter_cpp.language())

# The replacements of each operator. For a comparison: a limit moved by one, and the opposite comparison.
REPLACEMENTS = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "&&": ("||",), "||": ("&&",),
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("*",),
    "&": ("|",), "|": ("&",), "^": ("|",), "<<": (">>",), ">>": ("<<",),
    "+=": ("-=",), "-=": ("+=",), "*=": ("/=",), "/=": ("*=",), "|=": ("&=",), "&=": ("|=",), "^=": ("|=",),
    "<<=": (">>=",), ">>=": ("<<=",), "++": ("--",), "--": ("++",),
}  # fmt: skip
COMPARISONS = ("<", "<=", ">", ">=", "==", "!=")
CONNECTIVES = ("&&", "||")

# Nothing below these nodes is changed: they are not run-time code, or they determine types.
SKIPPED = frozenset(
    ("comment", "preproc_include", "preproc_def", "preproc_function_def", "preproc_call", "static_assert_declaration",
     "template_parameter_list", "template_argument_list", "operator_name", "attribute_declaration", "noexcept",
     "alignas_qualifier", "decltype", "fold_expression", "linkage_specification_string")
)  # fmt: skip
# Tokens in which spaces are significant.
LITERALS = frozenset(("string_literal", "raw_string_literal", "char_literal"))
INTEGER = re.compile(r"(0[xX][0-9A-Fa-f']+|[0-9']+)([uUlLzZ]*)")
INTEGER_TYPE = re.compile(r"(?:std::)?(?:u?int(?:8|16|32|64)_t|size_t|ptrdiff_t|int|unsigned)|double|float")
CHECK = re.compile(r"MAMORI_[A-Z]+")


@dataclass(frozen=True, order=True)
class Mutant:
    """One change: bytes `start` .. `end` - 1 of `file` become `replacement`."""

    file: str
    start: int
    end: int
    operator: str
    replacement: str

    def apply(self, source: bytes) -> bytes:
        return source[: self.start] + self.replacement.encode("utf-8") + source[self.end :]

    def get_line(self, source: bytes) -> int:
        return source.count(b"\n", 0, self.start) + 1

    def make_diff(self, source: bytes) -> str:
        """The changed lines, in the format of `diff -u` without context."""
        before = source.decode("utf-8").splitlines(keepends=True)
        after = self.apply(source).decode("utf-8").splitlines(keepends=True)
        lines = difflib.unified_diff(before, after, f"a/{self.file}", f"b/{self.file}", n=0)
        return "".join(lines)

    def get_change(self, source: bytes) -> tuple[str, str]:
        """The first changed line before and after, without indentation. It identifies the mutant after other lines move."""
        before = source.decode("utf-8").splitlines()
        after = self.apply(source).decode("utf-8").splitlines()
        number = next(index for index, pair in enumerate(zip(before, after, strict=True)) if pair[0] != pair[1])
        return before[number].strip(), after[number].strip()


def iterate_words(source: bytes) -> Iterator[bytes]:
    """The tokens of the code in order, without includes, comments and the spaces between tokens."""
    left = [Parser(LANGUAGE).parse(source).root_node]
    while left:
        node = left.pop()
        if node.type in ("comment", "preproc_include"):
            continue
        if node.child_count == 0 or node.type in LITERALS:
            yield source[node.start_byte : node.end_byte]
        else:
            left.extend(reversed(node.children))


def make_mutants(file: str, source: bytes) -> list[Mutant]:
    """All mutants of `source`, sorted by location. Two changes with equal results are one mutant. Examples have those of limits and wiring,
    too."""
    mutants: list[Mutant] = []
    seen: set[bytes] = {source}
    root = Parser(LANGUAGE).parse(source).root_node
    changes = {Mutant(file, node.start_byte, node.end_byte, operator, _keep_lines(node, replacement)) for node, operator, replacement in _walk(root)}
    if file.startswith("examples/"):
        changes.update(Mutant(file, *change) for change in wiring.make_changes(root))
    for mutant in sorted(changes):
        text = mutant.apply(source)
        if text not in seen:
            seen.add(text)
            mutants.append(mutant)
    return mutants


def _keep_lines(node: Node, replacement: str) -> str:
    return replacement + "\n" * (_text(node).count("\n") - replacement.count("\n"))


def _walk(root: Node) -> Iterator[tuple[Node, str, str]]:
    """(node, operator, replacement of the node) for every change below `root`."""
    pending = [root]
    while pending:
        node = pending.pop()
        if node.type in SKIPPED:
            continue
        yield from _change(node)
        pending.extend(child for child in node.children if not _is_number_of_check(child))


def _change(node: Node) -> Iterator[tuple[Node, str, str]]:
    match node.type:
        case "binary_expression" | "assignment_expression" | "update_expression":
            yield from _change_operator(node)
        case "number_literal":
            yield from _change_number(node)
        case "true" | "false":
            yield node, "boolean", "false" if node.type == "true" else "true"
        case "string_literal" if len(_text(node)) > 2 and node.parent and node.parent.type != "linkage_specification":
            yield node, "text", '""'
        case "unary_expression" if _operator(node) in ("!", "-", "~"):
            yield node, "unary removal", _text(node.child_by_field_name("argument"))
        case "expression_statement" if node.named_child_count > 0:
            yield node, "statement deletion", ";"
        case "break_statement" | "continue_statement":
            yield node, "statement deletion", ";"
        case "return_statement":
            yield from _change_return(node)
        case "if_statement" | "while_statement" | "do_statement" | "for_statement" | "conditional_expression":
            yield from _negate(node.child_by_field_name("condition"))


def _change_operator(node: Node) -> Iterator[tuple[Node, str, str]]:
    operator = node.child_by_field_name("operator")
    if operator is None:
        return
    word = _text(operator)
    kind = "comparison" if word in COMPARISONS else "connective" if word in CONNECTIVES else "arithmetic"
    for replacement in REPLACEMENTS.get(word, ()):
        yield operator, kind, replacement
    if word in CONNECTIVES:
        yield from _negate(node.child_by_field_name("left"))
        yield from _negate(node.child_by_field_name("right"))


def _change_number(node: Node) -> Iterator[tuple[Node, str, str]]:
    text = _text(node)
    integer = INTEGER.fullmatch(text)
    if integer is None:
        yield node, "constant", f"({text} + 1.0)"
        return
    value, suffix = int(integer[1].replace("'", ""), 0), integer[2]
    yield node, "constant", f"{value + 1}{suffix}"
    if value > 0:
        yield node, "constant", f"{value - 1}{suffix}"


def _change_return(node: Node) -> Iterator[tuple[Node, str, str]]:
    if node.named_child_count == 0:
        yield node, "statement deletion", ";"
        return
    value = node.named_children[0]
    type_name = _get_return_type(node)
    text = _text(value)
    if type_name == "bool" and not _is_covered(value):
        yield value, "return value", f"!({text})"
    elif type_name == "Status":
        yield value, "return value", "Status::kError" if text == "Status::kOk" else "Status::kOk"
    elif INTEGER_TYPE.fullmatch(type_name) and value.type != "number_literal":
        yield value, "return value", f"({text}) + 1"


def _get_return_type(node: Node) -> str:
    """Return type of the function that encloses `node`; empty in a lambda, whose type is not written."""
    above = node.parent
    while above is not None and above.type not in ("function_definition", "lambda_expression"):
        above = above.parent
    named = above.child_by_field_name("type") if above is not None else None
    return _text(named) if named is not None else ""


def _negate(condition: Node | None) -> Iterator[tuple[Node, str, str]]:
    """The condition of a statement, or an operand of `&&` or `||`, except conditions that another operator negates."""
    while condition is not None and condition.type in ("condition_clause", "parenthesized_expression"):
        condition = condition.named_children[0] if condition.named_child_count == 1 else None
    if condition is not None and condition.type != "declaration" and not _is_covered(condition):
        yield condition, "condition negation", f"!({_text(condition)})"


def _is_covered(node: Node) -> bool:
    """Comparisons, connectives, `!x` and literals, for which other mutants already negate the condition."""
    if node.type == "binary_expression":
        return _operator(node) in (*COMPARISONS, *CONNECTIVES)
    return node.type in ("true", "false") or (node.type == "unary_expression" and _operator(node) == "!")


def _is_number_of_check(node: Node) -> bool:
    """The first argument of a check is its number, which has no effect on the condition."""
    arguments = node.parent
    if arguments is None or arguments.type != "argument_list" or arguments.parent is None:
        return False
    function = arguments.parent.child_by_field_name("function")
    return function is not None and CHECK.fullmatch(_text(function)) is not None and node == arguments.named_children[0]


def _operator(node: Node) -> str:
    operator = node.child_by_field_name("operator")
    return _text(operator) if operator is not None else ""


def _text(node: Node | None) -> str:
    return node.text.decode("utf-8") if node is not None and node.text is not None else ""
