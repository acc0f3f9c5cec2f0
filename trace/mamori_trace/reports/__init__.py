# SPDX-License-Identifier: Apache-2.0
"""Reports: text and JSON for the console, one offline HTML file for people."""
