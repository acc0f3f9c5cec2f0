# SPDX-License-Identifier: Apache-2.0
"""Words that leave the requirement open or mark an unfinished text; for projects whose schema has no own list.

@satisfies SWR-TRC-024      Design: docs/design/trace.md#word-lists
"""

from __future__ import annotations

UNFINISHED_WORDS = ("tbd", "tbc", "todo", "fixme", "xxx", "lorem", "dummy", "placeholder", "to be defined", "to be determined",
                    "to be done")  # fmt: skip

WEAK_WORDS = (
    "appropriate", "appropriately", "adequate", "adequately", "sufficient", "sufficiently", "reasonable", "reasonably", "suitable",
    "suitably", "acceptable", "proper", "properly", "relevant", "as needed", "as necessary", "as required", "as applicable", "if needed",
    "if necessary", "if required", "if applicable", "where applicable", "if possible", "where possible", "when possible",
    "as far as possible", "as much as possible", "as soon as possible", "as fast as possible", "if practicable", "best effort",
    "to the extent possible", "fast", "quick", "quickly", "rapid", "rapidly", "slow", "slowly", "timely", "immediately", "soon enough",
    "easy", "easily", "simple to", "intuitive", "user-friendly", "user friendly", "robust", "flexible", "efficient", "efficiently",
    "effective", "effectively", "optimal", "optimally", "seamless", "seamlessly", "state of the art", "normally", "usually", "generally",
    "typically", "mostly", "often", "sometimes", "almost", "nearly", "approximately", "roughly", "more or less", "various", "etc",
    "and so on", "and the like", "and/or", "such as", "but not limited to", "among others", "should", "might",
)  # fmt: skip
