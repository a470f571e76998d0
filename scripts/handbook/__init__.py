# SPDX-License-Identifier: Apache-2.0
"""The handbook: all documents as pages that need no network. scripts/docs makes it."""
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
