# SPDX-License-Identifier: Apache-2.0
"""Fault campaigns in real time: three programs inject faults and record a course; one evaluator gives the verdict."""
