# SPDX-License-Identifier: Apache-2.0
"""Readers and writers of the files that the RT-middleware world already has. Files only; no C++ of ours."""
