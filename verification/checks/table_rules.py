# SPDX-License-Identifier: Apache-2.0
"""docs/manual/table_rules.md: the rules of a system table as the kernel states them in table_rules.hpp.

`python -P -m verification.checks.table_rules` writes the page.

@satisfies SWR-TAB-015      Design: docs/design/kernel.md#system-table
"""

from __future__ import annotations

import re
from pathlib import Path

from mamori_tools.host.project import ROOT
from mamori_trace.base.text_file import write_text

LIST = Path("kernel/include/mamori/kernel/table/table_rules.hpp")
PAGE = Path("docs/manual/table_rules.md")
RULE = re.compile(r'\bX\((\w+), (\w+), (\w+), ((?:\s*"[^"\n]*")+)\)')
FAULTY = re.compile(r"^///\s{13}(\w+)\s+(\S.*)$", re.MULTILINE)
QUOTE = '"'
HEAD = """\
# Rules of a system table

`MAMORI_CHECK` stops the compiler at the first violated rule. The message shows the template of the rule with the faulty element as its arguments, and
the sentence of the rule. `./mamori table` shows each finding of a table with its sentence. The source of this page is
`mamori/kernel/table/table_rules.hpp`; a test compares both.

| finding | compiler message | faulty element | rule |
|---|---|---|---|
"""


def make_page(text: str) -> str:
    """@param text of the list of rules."""
    body = text.replace("\\\n", "\n")
    elements = {name: words[0].lower() + words[1:] for name, words in FAULTY.findall(text)}
    rows = (f"| `{name}` | `{message}` | {elements[faulty]} | {''.join(sentence.split(QUOTE)[1::2])} |\n"
            for name, message, faulty, sentence in RULE.findall(re.sub(r",\s+", ", ", body)))  # fmt: skip
    return HEAD + "".join(rows)


if __name__ == "__main__":
    write_text(ROOT / PAGE, make_page((ROOT / LIST).read_text("utf-8")))
