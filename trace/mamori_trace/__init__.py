# SPDX-License-Identifier: Apache-2.0
"""Traceability: joins requirements, design, code, tests and fault-injection results, judges them, and reports.

The package reads files only. `command` is the way in; `docs/design/trace.md` explains rules and verdicts.
"""
