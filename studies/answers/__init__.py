"""Answers: what either model says of a problem, in a neutral form, and measures that compare two."""
