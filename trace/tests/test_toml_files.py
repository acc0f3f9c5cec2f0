# SPDX-License-Identifier: Apache-2.0
"""Goal: each invalid TOML file gives a message. Method: corrupt each file that a project may have."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from trace_sample import Sample

FILES = ("waivers.toml", "reviews.toml", "decomposition.toml", "schema/techniques.toml", "schema/items.toml", "schema/rules.toml",
         "schema/links.toml", "schema/code.toml")  # fmt: skip


@pytest.mark.parametrize("text", ["x = " + "[" * 5000, "x = " + "9" * 5000], ids=["nested deeply", "number of 5000 digits"])
@pytest.mark.parametrize("name", FILES)
@pytest.mark.verifies("SWR-TRC-009", technique="error_guessing", polarity="violation")
def test_what_the_parser_cannot_take_is_named(sample: Sample, trace: Callable, name: str, text: str) -> None:
    (sample.root / "requirements" / name).write_text(text, encoding="utf-8")

    outcome = trace("check", "--root", sample.root)

    assert outcome.status == 2
    assert name in outcome.out + outcome.err


@pytest.mark.parametrize("name", FILES)
@pytest.mark.verifies("SWR-TRC-009", technique="error_guessing", polarity="violation")
def test_a_loop_of_links_is_no_absent_file(sample: Sample, trace: Callable, name: str) -> None:
    path = sample.root / "requirements" / name
    path.unlink(missing_ok=True)
    path.symlink_to(path.name)

    outcome = trace("check", "--root", sample.root)

    assert outcome.status == 2
    assert name in outcome.out + outcome.err
