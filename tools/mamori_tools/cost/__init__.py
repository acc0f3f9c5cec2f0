# SPDX-License-Identifier: Apache-2.0
"""`./mamori cost SYSTEM`: exact instructions of each step of each component, and what they say about its budgets (docs/design/cost.md)."""
