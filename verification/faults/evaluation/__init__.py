# SPDX-License-Identifier: Apache-2.0
"""The evaluator checks that each injection has its declared report in time, and each report an injection or a host cause."""
