# SPDX-License-Identifier: Apache-2.0
"""Reads the file of a flight recorder and shows or exports it: `mamori log`."""
