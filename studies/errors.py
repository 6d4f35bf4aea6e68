"""Errors that a user of the command line can mend."""


class BadInput(ValueError):
    """Input that cannot be worked with; its text is one line that says what was got and what was expected."""
