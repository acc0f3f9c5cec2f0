# SPDX-License-Identifier: Apache-2.0
"""docs/manual/table_rules.md: all compiler messages of kernel and safety, extracted from their headers.

Sources: rules of a system table from table_rules.hpp, rules of state machines and configurations from enumerations, others from assertions.

`python -P -m verification.checks.table_rules` writes the page.

@satisfies SWR-TAB-015      Design: docs/design/kernel.md#system-table
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from mamori_tools.host.project import ROOT
from mamori_trace.base.text_file import write_text

INCLUDES = (Path("kernel/include"), Path("safety/include"))
LIST = INCLUDES[0] / "mamori/kernel/table/table_rules.hpp"
STATE_MACHINES = INCLUDES[0] / "mamori/kernel/component/fsm_check.hpp"
CONFIGURATIONS = INCLUDES[0] / "mamori/kernel/parameter/configuration_finding.hpp"
PAGE = Path("docs/manual/table_rules.md")
RULE = re.compile(r'\bX\((\w+), (\w+), (\w+), ((?:\s*"[^"\n]*")+)\)')
FAULTY = re.compile(r"^///\s{13}(\w+)\s+(\S.*)$", re.MULTILINE)
ENUMERATOR = re.compile(r"^    (k\w+),\s+///< (.*)$", re.MULTILINE)
# Indented assertions only: an assertion at the left margin is about the library itself and cannot fail in user programs.
ASSERTION = re.compile(r'^ +static_assert\([^;"]*,[\s\\]*((?:"[^"\n]*"[\s\\]*)+)\)', re.MULTILINE)
QUOTE = '"'
HEAD = """\
# Compiler messages

The sources of this page are the headers of kernel and safety; a test compares them.

## Rules of a system table
`MAMORI_CHECK` stops the compiler at the first violated rule. The message shows the template of the rule with the faulty element as its arguments, and
the sentence of the rule. `./mamori table` shows each finding of a table with its sentence. The source is `mamori/kernel/table/table_rules.hpp`.

| finding | compiler message | faulty element | rule |
|---|---|---|---|
"""
STATE_MACHINE_HEAD = """
## State machines
`MAMORI_CHECK_FSM` reports `FsmTableKeeps<rule, element>`.

| rule | element |
|---|---|
"""
CONFIGURATION_HEAD = """
## Configurations
`MAMORI_CHECK_CONFIGURATION` reports `ConfigurationKeeps<rule, set, assignment>`.

| rule | meaning |
|---|---|
"""
ASSERTION_HEAD = """
## Assertions
Each message follows the header that states it.

```text
"""
ASSERTION_END = "```\n"


def make_page(root: Path) -> str:
    """@param root of the project."""
    text = (root / LIST).read_text(encoding="utf-8")
    return (HEAD + "".join(_make_rules(text)) + STATE_MACHINE_HEAD + "".join(_make_enumerators(root / STATE_MACHINES))
            + CONFIGURATION_HEAD + "".join(_make_enumerators(root / CONFIGURATIONS)) + ASSERTION_HEAD + "".join(_make_assertions(root))
            + ASSERTION_END)  # fmt: skip


def _make_rules(text: str) -> Iterator[str]:
    elements = {name: words[0].lower() + words[1:] for name, words in FAULTY.findall(text)}
    for name, message, faulty, sentence in RULE.findall(re.sub(r",\s+", ", ", text.replace("\\\n", "\n"))):
        yield f"| `{name}` | `{message}` | {elements[faulty]} | {_join(sentence)} |\n"


def _make_enumerators(path: Path) -> Iterator[str]:
    for name, meaning in ENUMERATOR.findall(path.read_text(encoding="utf-8")):
        if name != "kNone":
            yield f"| `{name}` | {meaning} |\n"


def _make_assertions(root: Path) -> Iterator[str]:
    for folder in INCLUDES:
        for path in sorted((root / folder).rglob("*.hpp")):
            messages = dict.fromkeys(map(_join, ASSERTION.findall(path.read_text(encoding="utf-8"))))
            if messages:
                yield path.relative_to(root / folder).as_posix() + "\n"
            for message in messages:
                yield f"    {message}\n"


def _join(literals: str) -> str:
    """The text of adjacent string literals."""
    return "".join(literals.split(QUOTE)[1::2])


if __name__ == "__main__":
    write_text(ROOT / PAGE, make_page(ROOT))
