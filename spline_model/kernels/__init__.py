"""Compiled inner loops over flat tables; each file holds one operator and its table."""
