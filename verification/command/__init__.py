# SPDX-License-Identifier: Apache-2.0
"""The command `./mamori`. Its first half is the launcher script `mamori` in the project's root, which answers --help and wrong
words and installs what is missing; this package does the rest.

Of the script: @satisfies SWR-CLI-001, SWR-CLI-002, SWR-CLI-003, SWR-CLI-004, SWR-CLI-005
Design: docs/design/launcher.md#launcher
"""
