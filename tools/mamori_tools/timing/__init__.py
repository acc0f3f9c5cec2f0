# SPDX-License-Identifier: Apache-2.0
"""`./mamori timing`: lateness, execution times and end-to-end latency of a system in real time (docs/design/timing.md)."""
