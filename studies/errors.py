"""Errors that a user of the command line can mend, and answers that there are not."""

from argparse import ArgumentTypeError


class BadInput(ArgumentTypeError, ValueError):
    """Input that cannot be worked with; its text is one line that says what was got and what was expected.

    Raised by what reads a word of the command line, it is told as it stands, behind the word's name.
    """


class Unanswered(RuntimeError):
    """A model did not reach the end of what it was asked; one line that says where it stopped."""
