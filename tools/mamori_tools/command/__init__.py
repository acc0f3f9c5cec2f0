# SPDX-License-Identifier: Apache-2.0
"""The command `./mamori`. Its first part is the launcher script `mamori` in the project root: it prints the stored help texts, rejects
wrong arguments and installs missing packages. This package does the rest.
"""
