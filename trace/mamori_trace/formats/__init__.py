# SPDX-License-Identifier: Apache-2.0
"""Projects kept in the formats of other tools: one reader per format, one neutral model, judged in place or taken over.

@satisfies SWR-TRC-045      Design: docs/design/trace_formats.md#formats
"""
