# SPDX-License-Identifier: Apache-2.0
"""The trace tool at scale: a large clean project made on demand, and what judging it costs beside two peers (docs/design/trace.md#cache)."""
