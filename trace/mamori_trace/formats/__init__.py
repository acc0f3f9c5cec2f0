# SPDX-License-Identifier: Apache-2.0
"""Projects in the formats of other tools: one reader per format and one neutral model, for checks in place and for import.

@satisfies SWR-TRC-045      Design: docs/design/trace_formats.md#formats
"""
