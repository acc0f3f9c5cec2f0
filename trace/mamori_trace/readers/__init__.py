# SPDX-License-Identifier: Apache-2.0
"""Readers: each turns one kind of file into parts of the model, and tells what it could not read instead of stopping."""
