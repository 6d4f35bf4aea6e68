"""Tests of the exchange formats: section forces, files and the tables that describe them."""
