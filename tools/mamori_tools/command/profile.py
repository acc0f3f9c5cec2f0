# SPDX-License-Identifier: Apache-2.0
"""`./mamori profile check|show|convert|diff|find`: the files of OpenRTM's tools.

@satisfies SWR-PFL-003, SWR-PFL-010, SWR-PFL-011, SWR-PFL-012      Design: docs/design/profiles.md#commands
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mamori_tools.host.arguments import Command
from mamori_tools.host.exit_status import EXIT_OK, EXIT_USAGE
from mamori_tools.profiles.compare import Difference, compare, flatten
from mamori_tools.profiles.convert import convert, make_portable
from mamori_tools.profiles.deviation import Deviation
from mamori_tools.profiles.fields import read_fields
from mamori_tools.profiles.notes import list_notes
from mamori_tools.profiles.packages import KEYS, find_packages, resolve_components, select
from mamori_tools.profiles.profile import Profile, load_profile
from mamori_tools.profiles.view import RtsView
from mamori_trace.base.errors import InputError
from mamori_trace.base.text_file import refuse_output
from mamori_trace.base.whole_file import whole_file

EXIT_INVALID = 1
PRINTED_MAX = 1000
"""Maximum number of printed violations, and of deviations and notes."""
OPTIONS = {"tolerant": ("check", "show", "convert", "diff"), "schema": ("check", "show", "convert", "diff"), "json": ("check", "show", "diff", "find"),
           "out": ("convert",), "portable": ("convert",), "system": ("find",)}  # fmt: skip
"""Actions of each option."""
ACTIONS = {"check": 1, "show": 1, "convert": 1, "diff": 2, "find": 1}
"""Number of paths of each action."""


def run(arguments: argparse.Namespace) -> int:
    """@raise InputError in one line for wrong arguments or a file that cannot be read."""
    wanted = ACTIONS[arguments.action]
    if len(arguments.paths) != wanted and not (arguments.action == "find" and len(arguments.paths) > 1):
        raise InputError(f"profile {arguments.action}: {len(arguments.paths)} paths instead of {wanted}; see ./mamori profile --help")
    if "" in arguments.paths:
        raise InputError(f"profile {arguments.action}: a path is empty; specify a file")
    for option, actions in OPTIONS.items():
        if getattr(arguments, option) and arguments.action not in actions:
            raise InputError(f"profile: --{option} is for {', '.join(actions)}; omit it")
    if arguments.action == "convert" and arguments.out is None:
        raise InputError("profile: convert needs --out; see ./mamori profile --help")
    if arguments.action == "find":
        return _find(arguments)
    profiles = [load_profile(Path(path), arguments.tolerant, arguments.schema) for path in arguments.paths]
    if arguments.action == "check":
        return _check(profiles[0], arguments)
    for profile in profiles:
        if profile.violations:
            worst = profile.violations[0]
            hint = "correct the file" if arguments.tolerant else "correct the file or add --tolerant"
            print(f"mamori: {profile.path}:{worst.line}: {worst.place}: {worst.text}; {hint}", file=sys.stderr)
            return EXIT_USAGE if arguments.action == "diff" else EXIT_INVALID
    _warn(profiles)
    return {"show": _show, "convert": _convert, "diff": _diff}[arguments.action](profiles, arguments)


def _warn(profiles: list[Profile]) -> None:
    """Names the deviations of tolerated files on standard error."""
    for profile in profiles:
        for deviation in profile.deviations[:PRINTED_MAX]:
            place = f"{deviation.place}: " if deviation.place else ""
            print(f"mamori: {profile.path}:{deviation.line}: {deviation.id}: {place}{deviation.sentence}: {deviation.repair}", file=sys.stderr)
        if len(profile.deviations) > PRINTED_MAX:
            print(f"mamori: {profile.path}: {len(profile.deviations) - PRINTED_MAX} more deviations", file=sys.stderr)


def _check(profile: Profile, arguments: argparse.Namespace) -> int:
    notes = [] if profile.root is None or profile.violations else list_notes(profile.root, profile.family, profile.table)
    is_valid = not profile.violations
    if arguments.json:
        _print_json({
            "file": str(profile.path), "profile": profile.family, "form": profile.form, "version": profile.version,
            "mode": "tolerant" if arguments.tolerant else "strict", "valid": is_valid,
            "violations": [dataclasses.asdict(violation) for violation in profile.violations],
            "deviations": [_list_parts(deviation) for deviation in profile.deviations], "notes": [_list_parts(note) for note in notes],
        })  # fmt: skip
        return EXIT_OK if is_valid else EXIT_INVALID
    for violation in profile.violations[:PRINTED_MAX]:
        print(f"{profile.path}:{violation.line}: {': '.join(filter(None, (violation.place, violation.text)))}")
    others = [*(("deviation", own) for own in profile.deviations), *(("note", own) for own in notes)]
    for word, deviation in others[:PRINTED_MAX]:
        place = f"{deviation.place}: " if deviation.place else ""
        print(f"{profile.path}:{deviation.line}: {word} {deviation.id}: {place}{deviation.sentence}: {deviation.repair}")
    more = max(len(profile.violations) - PRINTED_MAX, 0) + max(len(others) - PRINTED_MAX, 0)
    if more:
        print(f"{profile.path}: {more} more, see --json")
    verdict = "valid" if is_valid else f"invalid, {_count(len(profile.violations), 'violation')}"
    extent = f" with {_count(len(profile.deviations), 'deviation')}" if profile.deviations else ""
    print(f"{profile.path}: {profile.title}: {verdict}{extent}")
    return EXIT_OK if is_valid else EXIT_INVALID


def _count(number: int, word: str) -> str:
    return f"{number} {word}{'' if number == 1 else 's'}"


def _list_parts(deviation: Deviation) -> dict[str, Any]:
    return {**dataclasses.asdict(deviation), "sentence": deviation.sentence}


def _print_json(content: object) -> None:
    print(json.dumps(content, ensure_ascii=False, indent=1))


def _show(profiles: list[Profile], arguments: argparse.Namespace) -> int:
    [profile] = profiles
    if arguments.json:
        _print_json({"file": str(profile.path), "profile": profile.family, "version": profile.version,
                     "deviations": [_list_parts(deviation) for deviation in profile.deviations], "values": flatten(profile)})  # fmt: skip
        return EXIT_OK
    print(f"{profile.path}: {profile.title}")
    for title, lines in {"rtc": _list_fields, "rts": _list_system, "conf": _list_keys}[profile.family](profile):
        print(f"\n{title}")
        width = max((len(label) for label, _ in lines), default=0)
        for label, value in lines:
            print(f"  {label:<{width}}  {value}".rstrip())
    return EXIT_OK


def _list_fields(profile: Profile) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Fields with a value, by form and element."""
    groups: dict[tuple[str, object], list[tuple[str, str]]] = {}
    for own in sorted(read_fields(profile.root, profile.table), key=lambda found: found.part):
        if own.value:
            groups.setdefault((own.field.title, own.owner), []).append((" ".join((own.part, own.field.label)).strip(), own.value))
    for (title, _), lines in groups.items():
        yield title, lines


def _list_system(profile: Profile) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    view = RtsView(profile.root, profile.table)
    yield "system", [("id", view.get_value("id")), ("summary", view.get_value("abstract"))]
    for own in view.components:
        lines = [("id", own.get_value("id")), ("composite", own.get_value("compositeType")), ("active set", own.get_value("activeConfigurationSet"))]
        contexts = own.list_parts("ExecutionContexts")
        lines += [(f"context {part.get_value('id')}".rstrip(), f"{part.get_value('kind')} {part.get_value('rate')}") for part in contexts]
        lines += [("port", part.name) for part in own.list_parts("DataPorts", "ServicePorts")]
        lines += [(f"set {group.get_value('id')}", f"{part.name}={part.get_value('data')}")
                  for group in own.list_parts("ConfigurationSets") for part in group.list_parts("ConfigurationData")]  # fmt: skip
        yield f"component {own.get_value('instanceName')}", lines
    for connector in view.connectors:
        source, target = (f"{end.get_value('instanceName')}.{end.get_value('portName').rpartition('.')[2]}" if end else "" for end in view.get_ends(connector))
        lines = [("ends", f"{source} -> {target}"), *((name, connector.get_value(name)) for name in ("dataType", "dataflowType", "subscriptionType"))]
        yield f"connector {connector.name}", [line for line in lines if line[1]]
    for name, targets in view.orders.items():
        yield name, [(part.get_value("sequence"), part.list_parts("TargetComponent")[0].get_value("instanceName")) for part in targets]


def _list_keys(profile: Profile) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    yield "keys", list(flatten(profile).items())


def _convert(profiles: list[Profile], arguments: argparse.Namespace) -> int:
    [profile] = profiles
    lost = make_portable(profile) if arguments.portable else []
    content, losses = convert(profile, arguments.out)
    try:
        with whole_file(arguments.out) as part:
            part.write_bytes(content)
    except OSError as error:
        raise refuse_output(arguments.out, error) from error
    for loss in [*lost, *losses]:
        print(f"mamori: not kept: {loss}", file=sys.stderr)
    print(f"mamori: wrote {arguments.out}", file=sys.stderr)
    return EXIT_OK


def _diff(profiles: list[Profile], arguments: argparse.Namespace) -> int:
    first, second = profiles
    if first.family != second.family:
        raise InputError(f"profile diff: {first.path} is an {first.title}, {second.path} an {second.title}; compare profiles of one kind")
    differences = compare(first, second)
    if arguments.json:
        deviations = [{"file": str(profile.path), **_list_parts(deviation)} for profile in profiles for deviation in profile.deviations]
        _print_json({"differences": [dataclasses.asdict(difference) for difference in differences], "deviations": deviations})
    else:
        for difference in differences:
            print(_format_difference(difference))
    return EXIT_INVALID if differences else EXIT_OK


def _format_difference(difference: Difference) -> str:
    if difference.first is None:
        return f"+ {difference.place}: {difference.second}"
    if difference.second is None:
        return f"- {difference.place}: {difference.first}"
    return f"~ {difference.place}: {difference.first} -> {difference.second}"


def _find(arguments: argparse.Namespace) -> int:
    folder, *words = arguments.paths
    criteria = []
    for word in words:
        key, sign, pattern = word.partition("=")
        if not sign:
            raise InputError(f"profile find: '{word}' is not KEY=PATTERN; keys: {', '.join(KEYS)}")
        criteria.append((key, pattern))
    packages, errors = find_packages(Path(folder))
    for error in errors:
        print(f"mamori: {error}", file=sys.stderr)
    if arguments.system is None:
        rows = [(package.id, package.path) for package in select(packages, criteria)]
    elif criteria:
        raise InputError("profile find: --system needs no KEY=PATTERN; omit it")
    else:
        system = load_profile(arguments.system, tolerant=True)
        if system.family != "rts" or system.violations:
            raise InputError("not an RTS profile that can be used; see ./mamori profile check", arguments.system)
        rows = [(instance, package.path) for instance, package in resolve_components(system, packages).items()]
    if arguments.json:
        _print_json([{"instance" if arguments.system else "id": name, "file": str(path)} for name, path in rows])
    else:
        width = max((len(name) for name, _ in rows), default=0)
        for name, path in rows:
            print(f"{name:<{width}}  {path}")
    return EXIT_OK if rows else EXIT_INVALID


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.usage = ("%(prog)s check|show FILE [--tolerant] [--schema FOLDER] [--json]\n       %(prog)s convert FILE --out FILE [--tolerant] [--portable]\n"
                    "       %(prog)s diff FILE FILE [--tolerant] [--json]\n       %(prog)s find FOLDER [KEY=PATTERN ...] [--system FILE] [--json]")  # fmt: skip
    parser.add_argument("action", choices=list(ACTIONS), metavar="check, show, convert, diff, find",
                        help="check against the schema; show the content; write another form; compare two files; search component packages")  # fmt: skip
    parser.add_argument("paths", nargs="+", metavar="FILE",
                        help=f"RTC.xml, RTS.xml or its YAML form, or rtc.conf; find: a folder and patterns with * and ? for {', '.join(KEYS)}")  # fmt: skip
    parser.add_argument("--tolerant", action="store_true", help="accept the known deviations of other tools, and name each")
    parser.add_argument("--schema", type=Path, metavar="FOLDER", help="check against the published schema files in FOLDER")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--out", type=Path, metavar="FILE", help="convert: file to write, .xml, .yaml or .conf")
    parser.add_argument("--portable", action="store_true", help="convert: a form of RTS.xml that rtsprofile reads as well")
    parser.add_argument("--system", type=Path, metavar="FILE", help="find: RTS.xml; show the package of each component")


COMMAND = Command(
    add_arguments, run, "checks, shows, converts and compares profiles of RT-middleware, and finds component packages",
    "Reads the files of OpenRTM's tools: RTC.xml (0.1 to 0.3), RTS.xml (0.1, 0.2), its YAML form and rtc.conf. The strict check has the verdict of "
    "xmllint with the schema of the version that the file names.",
    {1: "check: invalid; diff: different; find: nothing found; show and convert: the file is invalid"},
    examples=("profile check RTC.xml", "profile check old_system.xml --tolerant --json", "profile convert RTS.xml --out RTS.yaml",
              "profile find components data-type=*TimedDoubleSeq language=C++"))  # fmt: skip
