"""Content: what the sections quote, by section: numbers, sentences that hold, tables."""
