# SPDX-License-Identifier: Apache-2.0
"""The command `./mamori`. Its first half is the launcher script `mamori` in the project's root, which answers --help and wrong
words and installs what is missing; this package does the rest.
"""
