# SPDX-License-Identifier: Apache-2.0
"""`./mamori hil`: hardware in the loop. Plant, kernel and controller are processes on an LCM network of their own."""
