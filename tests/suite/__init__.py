"""Tests of the suite's own machinery: bad input, import rules, gates, the store, the command line."""
