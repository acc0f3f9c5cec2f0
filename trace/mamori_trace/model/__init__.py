# SPDX-License-Identifier: Apache-2.0
"""The data model of the trace tool: items, evidence, findings, and the project that joins them."""
