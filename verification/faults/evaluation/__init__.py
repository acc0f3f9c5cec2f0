# SPDX-License-Identifier: Apache-2.0
"""The evaluator: has each injection its declared report in time, and each report an injection or a host cause?"""
