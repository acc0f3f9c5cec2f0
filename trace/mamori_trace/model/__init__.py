# SPDX-License-Identifier: Apache-2.0
"""What the trace tool knows: items, evidence, findings, and the project that joins them."""
