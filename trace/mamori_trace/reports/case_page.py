# SPDX-License-Identifier: Apache-2.0
"""Writes one campaign case as a separate page, with its drawings and checks from the report.

    write_case_page(make_case(CaseResult.to_json()), evidence / "campaign", Path("case.html"))

@satisfies SWR-TRC-112      Design: docs/design/trace.md#plots
"""

from __future__ import annotations

from pathlib import Path

from markupsafe import escape

from mamori_trace.base.write import write_whole_bytes
from mamori_trace.model.evidence import CampaignCase
from mamori_trace.reports.campaign_view import CaseView, make_case_view
from mamori_trace.reports.templating import make_environment


class _PlainIds:
    """A single case has no items to link to."""

    def link_item(self, item_id: str) -> str:
        return f'<span class="id">{escape(item_id)}</span>'


def write_case_page(case: CampaignCase, base: Path, out: Path) -> CaseView:
    """Writes the page of `case` to `out`. `base`: folder of the campaign, which contains the folder of the case.

    @return the displayed case; `plot_problem`: why the run cannot be drawn. @raise OSError if `out` cannot be written.
    """
    view = make_case_view(case, base)
    page = make_environment().get_template("case_page.html.j2").render(view=view, static=_PlainIds(), anchors={})
    write_whole_bytes(out, page.encode("utf-8", errors="replace"))
    return view
