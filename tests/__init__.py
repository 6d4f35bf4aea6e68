"""Tests of the suite; see CONTRIBUTING.md for the six kinds and where each lives."""
