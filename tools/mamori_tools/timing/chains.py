# SPDX-License-Identifier: Apache-2.0
"""The event chains of a table: the components that a value passes from sampling to effect, and the instants in virtual time.

Source: reaction time over sampled chains as in Feiertag et al., "A compositional framework for end-to-end path delay
        calculation of automotive systems under different path semantics", 2008; strongly connected components by Tarjan, 1972,
        here as mutual reachability.

@satisfies SWR-TIM-015, SWR-TIM-016      Design: docs/design/timing.md#chains
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mamori_tools.table.document import Table
from mamori_tools.timing.reader import Array

CHAINS_MAX = 64
"""Maximum number of paths for a reader; a table with fully connected layers has millions."""
VISITS_MAX = 100_000
"""Maximum number of search steps, so that tables with many dead ends cannot block the command."""
SAME_WINDOW = "same_window"


@dataclass(frozen=True)
class Link:
    """One connection of a chain: `is_direct` forwards the value within the same window instance."""

    source: int
    sink: int
    is_direct: bool


@dataclass(frozen=True)
class Chain:
    """A path of components (indices into the table) and the links between them."""

    components: tuple[int, ...]
    links: tuple[Link, ...]

    def name(self, table: Table) -> str:
        return " > ".join(table.component_name(index) for index in self.components)


@dataclass(frozen=True)
class ChainSet:
    chains: tuple[Chain, ...]
    note: str = ""  # reason of missing chains, or ignored feedback


@dataclass(frozen=True)
class Sensitivity:
    """Permitted growth of the budget of one window of a chain without effect on the response.

    Outputs are published at the planned window end, for any execution time. The budget may therefore grow by `budget_growth_ns` within the
    window length, and the length by `core_gap_ns` until the next window of the core. From a growth by `reader_gap_ns`, the next window of
    the chain would read one window instance later. `response_per_length`: growth of the response per growth of the length, 1 for the acting
    window and 0 for all others.
    """

    window: str
    budget_ns: int
    length_ns: int
    budget_growth_ns: int
    core_gap_ns: int
    reader_gap_ns: int | None
    response_per_length: int


@dataclass(frozen=True)
class Response:
    """Virtual time of one chain [ns]: from the sampling window start to the planned end of the acting window.

    `reaction_max_ns`: from an event directly after the sample at the instant `worst_phase_ns` of the major frame. This event waits for the
    next sample.
    """

    min_ns: int
    max_ns: int
    reaction_max_ns: int
    worst_phase_ns: int
    sensitivity: tuple[Sensitivity, ...]


def find_chains(table: Table, limit: int = CHAINS_MAX) -> ChainSet:
    """Simple paths from components without connected inputs to components without connected outputs, without feedback."""
    links = list_links(table)
    feedback = find_feedback(table, links)
    forward = [link for link in links if link not in feedback]
    notes = []
    if feedback:
        names = ", ".join(sorted({f"{table.component_name(one.source)} > {table.component_name(one.sink)}" for one in feedback}))
        notes.append(f"feedback is not followed: {names}")
    chains, is_cut = _walk(forward, limit)
    if is_cut:
        notes.append(f"only the first {len(chains)} chains are shown, there are more")
    return ChainSet(tuple(chains), "; ".join(notes))


def list_links(table: Table) -> list[Link]:
    """Pairs of connected components, once each. Of several connections of a pair, a direct one takes precedence."""
    found: dict[tuple[int, int], Link] = {}
    for one in table.connections:
        source, sink = one.source.component, one.sink.component
        if source is None or sink is None or (table.modes and not one.modes):
            continue
        if table.components[source].window is None or table.components[sink].window is None:
            continue
        is_direct = one.way == SAME_WINDOW or (found[source, sink].is_direct if (source, sink) in found else False)
        found[source, sink] = Link(source, sink, is_direct)
    return [found[key] for key in sorted(found)]


def find_feedback(table: Table, links: list[Link]) -> set[Link]:
    """Links to an earlier component that close a loop. Links to an earlier window that close no loop are not feedback."""
    reach = _find_reachable(links)

    def place(index: int) -> tuple[int, int]:
        window = table.components[index].window
        return (0 if window is None else table.windows[window].offset_ns, index)

    return {one for one in links if one.source in reach[one.sink] | {one.sink} and place(one.sink) <= place(one.source)}


def _find_reachable(links: list[Link]) -> dict[int, set[int]]:
    """Components that are reachable from each component; a component reaches itself only through a loop."""
    after: dict[int, set[int]] = {}
    for link in links:
        after.setdefault(link.source, set()).add(link.sink)
        after.setdefault(link.sink, set())
    reach: dict[int, set[int]] = {}
    for start in after:
        seen: set[int] = set()
        pending = list(after[start])
        while pending:
            here = pending.pop()
            if here not in seen:
                seen.add(here)
                pending.extend(after[here] - seen)
        reach[start] = seen
    return reach


def _walk(links: list[Link], limit: int) -> tuple[list[Chain], bool]:
    """All paths from starts to ends, depth first in table order. @return at most `limit` paths, and whether there are more.

    Without feedback there are no loops, so each path is simple and the search terminates.
    """
    after: dict[int, list[Link]] = {}
    for link in links:
        after.setdefault(link.source, []).append(link)
    fed = {link.sink for link in links}
    chains: list[Chain] = []
    pending: list[tuple[Link, ...]] = [(link,) for start in sorted(set(after) - fed, reverse=True) for link in reversed(after[start])]
    for _ in range(VISITS_MAX):
        if not pending:
            return chains, False
        path = pending.pop()
        following = after.get(path[-1].sink)
        if following:
            pending.extend((*path, link) for link in reversed(following))
            continue
        if len(chains) == limit:
            return chains, True
        chains.append(Chain((path[0].source, *(link.sink for link in path)), path))
    return chains, bool(pending)


def follow(table: Table, chain: Chain, samples: Array) -> list[Array]:
    """@param samples planned starts [ns] of the window of the first component. @return the planned starts at which each component first
    reads the values of these samples (logical execution time: published at the planned window end)."""
    releases = [samples]
    for link in chain.links:
        now = releases[-1]
        if not link.is_direct:
            source, sink = _window_of(table, link.source), _window_of(table, link.sink)
            published = now + table.windows[source].length_ns
            offset, period = table.windows[sink].offset_ns, table.windows[sink].period_ns
            now = offset + -(-(published - offset) // period) * period
        releases.append(now)
    return releases


def _window_of(table: Table, component: int) -> int:
    window = table.components[component].window
    if window is None:
        raise ValueError(f"component {component} is in no window")  # chains contain only components with a window
    return window


def calc_response(table: Table, chain: Chain) -> Response:
    """Exact over all samples of one major frame. Later frames are equal, because all periods divide the frame."""
    first, last = (table.windows[_window_of(table, chain.components[end])] for end in (0, -1))
    samples = np.arange(first.offset_ns, table.frame_ns, first.period_ns, dtype=np.int64)
    releases = follow(table, chain, samples)
    times = releases[-1] + last.length_ns - samples
    # Sample k + 1, one period later, is the first to read an event directly after sample k.
    reaction = first.period_ns + np.roll(times, -1)
    worst = int(np.argmax(reaction))
    return Response(int(times.min()), int(times.max()), int(reaction.max()), int(samples[worst]), _list_sensitivity(table, chain, releases))


def calc_bounds(table: Table, chain: Chain, samples: Array) -> Array:
    """Virtual response [ns] for each sample at a planned window start."""
    last = table.windows[_window_of(table, chain.components[-1])]
    return follow(table, chain, samples)[-1] + last.length_ns - samples


def _list_sensitivity(table: Table, chain: Chain, releases: list[Array]) -> tuple[Sensitivity, ...]:
    rows = []
    for place, component in enumerate(chain.components):
        is_last = place == len(chain.components) - 1
        if not is_last and chain.links[place].is_direct:
            continue  # one row per window, for its last component in the chain
        index = _window_of(table, component)
        window = table.windows[index]
        reader = None if is_last else int((releases[place + 1] - releases[place] - window.length_ns).min())
        rows.append(Sensitivity(window.name, window.budget_ns, window.length_ns, window.length_ns - window.budget_ns,
                                calc_core_gap(table, index), reader, int(is_last)))  # fmt: skip
    return tuple(rows)


def calc_core_gap(table: Table, window: int) -> int:
    """Minimum time [ns] from a planned end of `window` to the next planned window start on its core.

    Two strictly periodic windows occur at every distance that equals their first distance modulo the gcd of their periods.
    """
    mine = table.windows[window]
    gaps = [mine.period_ns - mine.length_ns]
    for other in table.windows_of(mine.core):
        if other != window:
            period = int(np.gcd(mine.period_ns, table.windows[other].period_ns))
            gaps.append((table.windows[other].offset_ns - mine.offset_ns - mine.length_ns) % period)
    return min(gaps)
