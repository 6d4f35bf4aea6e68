"""Families of static paths."""
