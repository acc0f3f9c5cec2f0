# SPDX-License-Identifier: Apache-2.0
"""End-to-end protection compared with an independent implementation."""
