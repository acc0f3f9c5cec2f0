# SPDX-License-Identifier: Apache-2.0
"""`./mamori cost SYSTEM`: exact instruction counts of each step of each component, compared with the budgets (docs/design/cost.md)."""
