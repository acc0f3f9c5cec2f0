# SPDX-License-Identifier: Apache-2.0
"""The example arm as subject of campaigns: its fault plan, its runs, and their evaluation by physics."""
