# SPDX-License-Identifier: Apache-2.0
"""The trace tool at scale: a large generated project, and the cost of its check compared with two other tools
(docs/design/trace.md#cache)."""
