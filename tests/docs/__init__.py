"""Tests of what is written for readers: pages, examples and the API reference."""
