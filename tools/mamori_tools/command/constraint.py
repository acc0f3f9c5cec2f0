# SPDX-License-Identifier: Apache-2.0
"""`./mamori constraint`: converts a constraint of the RTC Profile to the typed constraint of the kernel.

@satisfies SWR-PAR-010      Design: docs/design/parameters.md#notation
"""

from __future__ import annotations

import argparse
import re

from mamori_tools.host.arguments import Command, at_least_one
from mamori_tools.host.exit_status import EXIT_OK
from mamori_tools.profiles.constraint_parser import ConstraintError, parse_constraint
from mamori_tools.profiles.scalar_type import TYPES, ScalarType, make_enumeration
from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names

NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
ENUMERATION = re.compile(rf"{NAME.pattern}(::{NAME.pattern})*")
ELEMENTS_MAX = 65534
"""Arguments of mamori::Parameter."""


def run(arguments: argparse.Namespace) -> int:
    """@raise InputError for a constraint outside the notation, or an unknown type."""
    type_ = _read_type(arguments.type, arguments.names)
    if arguments.elements > ELEMENTS_MAX:
        raise InputError(f"constraint: argument --elements: {arguments.elements} is more than {ELEMENTS_MAX}; specify a smaller number")
    try:
        constraint = parse_constraint(arguments.text, type_, arguments.elements)
    except ConstraintError as error:
        raise InputError(f"constraint: {arguments.text!r}: {error}") from error
    print(f"canonical  {constraint.format_canonical()}".rstrip())
    print(f"C++        {constraint.format_cpp()}")
    return EXIT_OK


def _read_type(name: str, names: str | None) -> ScalarType:
    if names is None:
        if name not in TYPES:
            raise InputError(f"constraint: argument --type: unknown type '{name}'; {nearest_names(name, TYPES)}; for an enumeration add --names")
        return TYPES[name]
    if name in TYPES or not ENUMERATION.fullmatch(name):
        raise InputError(f"constraint: argument --names: '{name}' is not the name of an enumeration; specify it with --type")
    words = tuple(names.split(","))
    wrong = next((word for index, word in enumerate(words) if not NAME.fullmatch(word) or word in words[:index]), None)
    if wrong is not None:
        raise InputError(f"constraint: argument --names: '{wrong}' is not a name, or is a duplicate; specify names as in off,slow,fast")
    return make_enumeration(name, words)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("text", metavar="TEXT",
                        help="constraint, for example '0.1<=x<=3.0', '(1,2,4)' or '{pan: x>0, tilt: x<1}'; ' -1<=x' with a space")  # fmt: skip
    parser.add_argument("--type", default="double", metavar="TYPE",
                        help=f"C++ type of an element: {', '.join(list(TYPES)[:-1])}, {list(TYPES)[-1]}, or an enumeration; default: %(default)s")  # fmt: skip
    parser.add_argument("--names", metavar="A,B,...", help="names of the enumerators 0, 1, ... of an enumeration; very_slow is kVerySlow")
    parser.add_argument("--elements", type=at_least_one, default=1, metavar="N", help="number of elements of the parameter; default: %(default)s")


COMMAND = Command(
    add_arguments, run, "converts a constraint of the RTC Profile to C++",
    "Reads a constraint of a configuration parameter in the notation of the RTC Profile. Prints its canonical form and the typed constraint for "
    "mamori::Parameter. For a text that is not in the notation, prints the violated rule and the column.",
    examples=("constraint '0.1<=x<=3.0'", "constraint '(slow,fast)' --type Mode --names off,slow,fast"))  # fmt: skip
