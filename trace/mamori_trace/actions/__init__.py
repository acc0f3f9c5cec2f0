# SPDX-License-Identifier: Apache-2.0
"""The actions of `mamori trace`, one per module: `HELP`, `add_arguments(parser)` and `run(arguments)`, which returns the status.

All action modules are loaded to collect their arguments. Imports that only one action needs are therefore inside its `run`.
"""
