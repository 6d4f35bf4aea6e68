"""Families that ask statics and motion alike, and the summary of all."""
