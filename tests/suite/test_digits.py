"""What accuracy costs: the tables of docs/findings.md."""

import pytest

from studies.commands import readme
from studies.cost import settings
from studies.errors import BadInput


def test_blocks_are_put_between_their_marks():
    """Only what stands between the marks of a block is replaced; a page without them is refused."""
    first, second = readme._marks("costs"), readme._marks("hard cases")
    text = f"head\n{first[0]}\nold\n{first[1]}\nbody\n{second[0]}\nold\n{second[1]}\ntail"
    for name, made in (("costs", ["new"]), ("hard cases", iter(["newer", "newest"]))):
        text = readme._between(text, name, made, "PAGE.md")
    assert text == (
        f"head\n{first[0]}\n\nnew\n\n{first[1]}\nbody\n{second[0]}\n\nnewer\nnewest\n\n{second[1]}\ntail"
    )
    with pytest.raises(BadInput, match=r"PAGE\.md: got no marks, expected <!-- other: written by"):
        readme._between(text, "other", [], "PAGE.md")


def test_columns_are_groups_of_the_comparison():
    """Every column is a group of the comparison by that name."""
    assert set(readme.GROUPS) <= set(settings.GROUPS)
