# SPDX-License-Identifier: Apache-2.0
"""Imports an external project as Markdown items: new ids if the old ones do not fit, and a list of the parts that were not imported.

@satisfies SWR-TRC-049, SWR-TRC-051      Design: docs/design/trace_formats.md#import
"""

from __future__ import annotations

import csv
import io
import os
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.finding import Place, Problem
from mamori_trace.base.system_error import explain
from mamori_trace.formats.csv_file import escape_cell, unescape_cell
from mamori_trace.formats.items import convert
from mamori_trace.formats.mapping import Mapping
from mamori_trace.formats.model import ForeignItem, ForeignProject, Loss
from mamori_trace.formats.own import ATTRIBUTES, format_block
from mamori_trace.model.item import Item, Schema
from mamori_trace.model.lock import Review
from mamori_trace.model.new_item import find_highest

_NUMBER_MAX = 999
_MARKS = ("#", "```", "~~~", "- ", "* ", "|")
_LEVELS = {1: ("SWR",), 2: ("SYS", "SWR"), 3: ("STK", "SYS", "SWR")}


@dataclass(slots=True)
class Takeover:
    """`files` by path below the target folder; `ids` from old to new; `reviews` of the imported links."""

    files: dict[str, str] = field(default_factory=dict)
    ids: dict[str, str] = field(default_factory=dict)
    places: dict[str, Place] = field(default_factory=dict)
    reviews: list[Review] = field(default_factory=list)
    losses: list[Loss] = field(default_factory=list)


def take_over(
    foreign: ForeignProject, mapping: Mapping, schema: Schema, area: str, used: Sequence[str], problems: list[Problem]
) -> Takeover:
    """The files to write. New ids are above all ids in the texts `used`.

    Raises InputError if ids cannot be assigned; `problems` are the findings that the checks would report.
    """
    converted = convert(foreign, mapping, problems)
    judged = {item.id: item for item in reversed(converted.items)}
    outcome = Takeover(losses=list(foreign.losses))
    kept = [item for item in foreign.items if item.id in judged]
    doubles = [key for key, count in Counter(item.id for item in kept).items() if count > 1]
    if doubles:
        raise InputError(f"{judged[doubles[0]].place}: {doubles[0]} is defined more than once; mend it before the import")
    for item in foreign.items:
        if item.id not in judged:
            outcome.losses.append(Loss(item.place, f"{item.id}: the whole item, as {item.kind or 'its group'} is no requirement"))
    outcome.ids = _map_ids(kept, judged, list(converted.schema.levels), schema, area, used)
    outcome.places = {item.id: item.place for item in kept}
    blocks: dict[str, list[str]] = {}
    for item in kept:
        file = _name_file(item, foreign)
        blocks.setdefault(file, []).append(_format(item, judged[item.id], outcome, mapping, schema))
    for file, texts in blocks.items():
        header = foreign.headers.get(file) or f"# {file.rpartition('/')[2].removesuffix('.md').replace('_', ' ').capitalize()}"
        outcome.files[file] = header + "\n\n" + "\n".join(texts)
    return outcome


def _name_file(item: ForeignItem, foreign: ForeignProject) -> str:
    """Documents exported by Mamori keep their files; other files are named after their document or source file."""
    if item.document in foreign.headers and re.fullmatch(r"(?:[\w-]+/)*[\w.-]+\.md", item.document) and ".." not in item.document:
        return item.document
    source = item.document or item.place.file.rpartition("/")[2].partition(".")[0]
    return (re.sub(r"\W+", "_", source.lower()).strip("_") or "items") + ".md"


def _map_ids(
    kept: list[ForeignItem], judged: dict[str, Item], order: list[str], schema: Schema, area: str, used: Sequence[str]
) -> dict[str, str]:
    if all(schema.find_level(item.id) for item in kept):
        return {item.id: item.id for item in kept}
    levels = [level for level in order if any(item.level == level for item in judged.values())]
    targets = _LEVELS.get(len(levels))
    if targets is None:
        raise InputError(f"the project has {len(levels)} levels ({', '.join(levels)}), and 3 can be taken over; name them with --schema")
    prefixes = {target: f"SWR-{area}-" if target == "SWR" else f"{target}-" for target in targets}
    counts = Counter({target: find_highest(prefix, used) for target, prefix in prefixes.items()})
    ids = {}
    for item in kept:
        target = targets[levels.index(judged[item.id].level)]
        counts[target] += 1
        ids[item.id] = f"{prefixes[target]}{counts[target]:03}"
        if counts[target] > _NUMBER_MAX or schema.find_level(ids[item.id]) is None:
            raise InputError(f"{item.place}: {item.id} would become {ids[item.id]}, which is no id here; give another --area, or split the project")
    return ids


def _format(item: ForeignItem, judged: Item, outcome: Takeover, mapping: Mapping, schema: Schema) -> str:
    lost: list[tuple[str, str]] = []
    words = {
        "SIL": _choose(item, "sil", judged.sil, schema.sil, "QM", mapping, lost),
        "Verify": _choose(item, "verify", ", ".join(judged.verify), schema.verify, "test", mapping, lost),
        "Polarity": _choose(item, "polarity", ", ".join(judged.polarity), schema.polarity, "nominal", mapping, lost),
        "Design": item.attributes.get("Design") or "-",
        "Status": _choose(item, "status", judged.status, schema.status, "draft", mapping, lost),
    }
    known = {name for key in ("sil", "status", "verify", "polarity") for name in mapping.lists[key]} | {"Design"}
    lost += [(name, f"attribute {name}: {' '.join(value.split())[:60]}") for name, value in item.attributes.items() if value and name not in known]
    parents = _list_parents(item, judged, outcome)
    statement, rationale = item.statement or "", item.rationale
    for name, text in (("statement", statement), ("rationale", rationale), ("title", item.title)):
        if "\n" in text.strip():
            lost.append((name, f"line breaks of the {name}"))
    for name, what in lost:
        outcome.losses.append(Loss(Place(item.place.file, item.lines.get(name, item.place.line)), f"{item.id}: {what}"))
    plain = " ".join(statement.split())
    made = replace(item, id=outcome.ids[item.id], title=" ".join(item.title.split()) or item.id, rationale=" ".join(rationale.split()),
                   statement="\\" + plain if plain.startswith(_MARKS) else plain)  # fmt: skip
    return format_block(made, parents, {name: words[name] for name in ATTRIBUTES})


def _choose(
    item: ForeignItem, key: str, judged: str, known: tuple[str, ...], default: str, mapping: Mapping, lost: list[tuple[str, str]]
) -> str:
    """The word of the item if the schema knows it; otherwise the word that the rules used, or a reported default."""
    name = next((each for each in mapping.lists[key] if item.attributes.get(each, "").strip()), "")
    given = item.attributes.get(name, "").strip()
    if given and all(word.strip() in known for word in given.split(",")):
        return given
    if judged and all(word.strip() in known for word in judged.split(",")) and (given or key in ("verify", "polarity")):
        if given.lower() != judged.lower() and given:
            lost.append((name, f"{name} '{given}' became {judged}"))
        return judged
    lost.append((name, f"{name} '{given}' became {default}" if given else f"no {key}: {default} was written"))
    return default


def _list_parents(item: ForeignItem, judged: Item, outcome: Takeover) -> list[str]:
    """Parents under their new ids. Parents that cannot be imported are reported."""
    for each in item.relations:
        place = Place(item.place.file, each.line)
        if each.target not in outcome.ids or outcome.ids[each.target] == outcome.ids[item.id]:
            outcome.losses.append(Loss(place, f"{item.id}: relation {each.role} to {each.target}, which is no item here"))
        elif each.name:
            outcome.losses.append(Loss(place, f"{item.id}: name '{each.name}' of the relation to {each.target}"))
        cells = each.review.split(maxsplit=3)
        if len(cells) == 4 and outcome.ids.get(each.target) == each.target and outcome.ids[item.id] == item.id:
            outcome.reviews.append(Review(item.id, each.target, *cells))
    return [outcome.ids[parent] for parent in judged.parents if parent in outcome.ids]


def format_map(outcome: Takeover) -> str:
    """Old id, new id and location, as CSV."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["old", "new", "file", "line"])
    rows = ([old, new, outcome.places[old].file, str(outcome.places[old].line)] for old, new in outcome.ids.items())
    writer.writerows([escape_cell(cell) for cell in row] for row in rows)
    return out.getvalue()


def find_earlier(outcome: Takeover, maps: dict[str, str]) -> str:
    """Reports an item of the same file that is in one of `maps`, the texts of earlier imports by name. @return "" if there is none."""
    for name, text in sorted(maps.items()):
        for line, cells in enumerate(csv.reader(io.StringIO(text)), start=1):
            row = [unescape_cell(cell) for cell in cells]
            if len(row) == 4 and row[0] in outcome.ids and row[2] == outcome.places[row[0]].file:
                return f"{name}:{line}: {row[0]} of {row[2]} was taken over before, as {row[1]}; leave it out, or take that map away to have it twice"
    return ""


def write_takeover(outcome: Takeover, folder: Path, map_name: str) -> list[Path]:
    """Writes all files or none. Raises InputError if a file already exists or cannot be written."""
    files = {folder / name: text for name, text in outcome.files.items()} | {folder / map_name: format_map(outcome)}
    present = sorted(path for path in files if os.path.lexists(path))
    if present:
        raise InputError(f"{present[0]}: is there already, and an import overwrites nothing; name another folder with --into")
    written: list[Path] = []
    try:
        for path, text in sorted(files.items()):
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("x", encoding="utf-8", newline="\n") as stream:
                written.append(path)
                stream.write(text)
    except OSError as error:
        take_back(written)
        raise InputError(f"{path}: cannot be written: {explain(error)}; nothing was taken over") from None
    except BaseException:  # half of a surrogate pair, or Ctrl-C
        take_back(written)
        raise
    return written


def take_back(written: list[Path]) -> None:
    """Removes the written files after a later failure."""
    for path in written:
        path.unlink(missing_ok=True)
