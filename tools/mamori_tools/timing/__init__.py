# SPDX-License-Identifier: Apache-2.0
"""`./mamori timing`: how late, how long and how far through, of a system that ran in real time (docs/design/timing.md)."""
