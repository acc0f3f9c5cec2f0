# SPDX-License-Identifier: Apache-2.0
"""Traceability: joins requirements, design, code, tests and fault-injection results, evaluates them, and reports.

The package reads files only. `command` is the entry point; `docs/design/trace.md` explains rules and verdicts.
"""
