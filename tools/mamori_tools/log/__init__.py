# SPDX-License-Identifier: Apache-2.0
"""Reads what a flight recorder left and shows or exports it: `mamori log`."""
