"""The error that ends a build: one line that says what the report lacks."""

from studies.errors import BadInput


class ReportError(BadInput):
    """A number, figure or sentence that the stored results do not give."""
