# SPDX-License-Identifier: Apache-2.0
"""The help text of a parser. It depends only on the parser, not on terminal, environment or Python version.

The stored copies in command/help are made by `python -P -m mamori_tools.command.help_texts`.

@satisfies SWR-CLI-004      Design: docs/design/launcher.md#launcher
"""

from __future__ import annotations

import argparse
import textwrap
from collections.abc import Iterator, Mapping

WIDTH = 100
COLUMN_MAX = 24
"""The description of a longer option starts on the next line."""
INSTALL = ("--install", "first install the missing Debian packages that the command needs (needs root or sudo). Without it, the command asks "
           "on a terminal. Elsewhere it names the packages and ends with status 3")  # fmt: skip
STATUSES = {0: "success", 1: "something failed, or there are findings", 2: "wrong arguments or input",
            3: "a tool or package is missing, or another command writes here", 130: "stopped by Ctrl-C"}  # fmt: skip


def format_help(parser: argparse.ArgumentParser, statuses: Mapping[int, str], usage_end: str) -> str:
    """@param statuses replaces or extends the common exit statuses. @return the text, with a line end."""
    rows = [(group, [row for action in group._group_actions for row in _list_rows(action, parser.prog)]) for group in parser._action_groups]
    common = [row for group, found in rows[:2] for row in found if not row[0].startswith("-h")]
    parts = [_format_usage(parser, usage_end), _wrap(parser.description or ""), _format_rows(common)]
    parts += [[f"{group.title}:", *_format_rows(found)] for group, found in rows[2:] if found]
    parts += [_format_rows([("-h, --help", "show this text"), INSTALL]), _wrap(parser.epilog or "")]
    parts.append(["exit status:", *_format_rows([(str(status), text) for status, text in sorted({**STATUSES, **statuses}.items())])])
    return "\n\n".join("\n".join(part) for part in parts if part) + "\n"


def _format_usage(parser: argparse.ArgumentParser, usage_end: str) -> list[str]:
    program = f"./{parser.prog}"
    if parser.usage:
        return [f"usage: {parser.usage % {'prog': program}}"]
    words = [_name_positional(action) for action in parser._actions if not action.option_strings]
    words += _list_option_words(parser)
    lead = f"usage: {program} "
    lines, line = [], lead
    for word in [*words, usage_end] if usage_end else words:  # a word stays on one line with its value or its alternatives
        if len(line) + len(word) > WIDTH and line.strip() != lead.strip():
            lines.append(line.rstrip())
            line = " " * len(lead)
        line += f"{word} "
    return [*lines, line.rstrip()]


def _list_option_words(parser: argparse.ArgumentParser) -> Iterator[str]:
    groups = {id(action): group for group in parser._mutually_exclusive_groups for action in group._group_actions}
    for action in parser._actions:
        group = groups.get(id(action))
        if isinstance(action, argparse._HelpAction) or not action.option_strings or (group and group._group_actions[0] is not action):
            continue
        word = " | ".join(map(_name_option, group._group_actions if group else [action]))
        yield word if action.required or (group and group.required) else f"[{word}]"


def _list_rows(action: argparse.Action, prog: str) -> Iterator[tuple[str, str]]:
    if isinstance(action, argparse._SubParsersAction):
        for choice in action._choices_actions:
            yield choice.dest, choice.help or ""
    else:
        text = (action.help or "") % {**vars(action), "prog": f"./{prog}"}
        yield (_name_option(action) if action.option_strings else _name_positional(action).strip("[]")), text


def _name_option(action: argparse.Action) -> str:
    return " ".join([", ".join(action.option_strings), *_name_value(action)])


def _name_positional(action: argparse.Action) -> str:
    [name] = _name_value(action)
    return f"[{name}]" if action.nargs in ("*", "?") else name


def _name_value(action: argparse.Action) -> list[str]:
    if action.nargs == 0:
        return []
    name = action.metavar or ("|".join(map(str, action.choices)) if action.choices else action.dest.upper())
    if isinstance(name, tuple):
        return [" ".join(name)]
    return [f"{name} ..."] if action.nargs in ("+", "*", argparse.PARSER) else [name]


def _format_rows(rows: list[tuple[str, str]]) -> list[str]:
    column = max((len(name) for name, _ in rows if len(name) <= COLUMN_MAX), default=0) + 4
    lines = []
    for name, text in rows:
        found = _wrap(text, column)
        if len(name) + 4 <= column and found:
            found[0] = f"  {name}".ljust(column) + found[0][column:]
        else:
            found.insert(0, f"  {name}")
        lines += found
    return lines


def _wrap(text: str, indent: int = 0) -> list[str]:
    """Wraps each line of `text` separately and keeps its indentation."""
    lines = []
    for line in text.splitlines():
        lead = " " * (indent + len(line) - len(line.lstrip()))
        lines += textwrap.wrap(line.strip(), WIDTH, initial_indent=lead, subsequent_indent=lead, break_long_words=False,
                               break_on_hyphens=False) or [""]  # fmt: skip
    return lines
