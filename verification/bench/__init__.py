# SPDX-License-Identifier: Apache-2.0
"""`./mamori bench`: what the kernel costs beside floors and peers, and how many instructions its operations take exactly.

Design: docs/design/bench.md
"""
