"""Stored answers of every command on every shipped case and published problem, and their comparison."""
