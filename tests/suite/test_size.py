"""The count of the suite's size."""

from tests.size import code_lines, public_names

SOURCE = '''"""Two lines
of text."""

# a comment
VALUE = """text
that is code"""


class Shown:
    """What it is."""


def _hidden(
    x,
):
    return x  # beside code
'''


def test_lines_of_code():
    """Blanks, comments and docstrings are no code; a text that is used is, by all of its lines."""
    assert code_lines(SOURCE) == 2 + 1 + 4
    assert public_names(SOURCE) == 1
