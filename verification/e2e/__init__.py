# SPDX-License-Identifier: Apache-2.0
"""End-to-end protection beside an implementation by others, and all its undetected errors.

Design: docs/design/e2e.md#comparison
"""
