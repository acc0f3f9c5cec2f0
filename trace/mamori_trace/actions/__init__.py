# SPDX-License-Identifier: Apache-2.0
"""What `mamori trace` can do, one action per module: `HELP`, `add_arguments(parser)` and `run(arguments)`, which returns the status.

Modules of actions are all loaded to know their arguments, so what only one action needs is imported inside its `run`.
"""
