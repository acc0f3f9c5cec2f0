# SPDX-License-Identifier: Apache-2.0
"""The project, its steps and their processes, for all tools."""
