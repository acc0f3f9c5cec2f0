# SPDX-License-Identifier: Apache-2.0
"""Notations of the RTC Profile."""
