"""Docstrings of this repository as Sphinx wants them.

They are prose with formulas in plain text, where `|r|`, `a*` and `q_` mean what they look like. So nothing in
them is markup but backticks: an indented block is a formula or a command line as it stands, as is an example
that begins with >>>. A section ("Args:", "Raises:", or underlined as numpydoc has it) is a list of its
entries.
"""

import re
import textwrap

PACKAGES = ("spline_model", "fe_reference", "studies")
SECTIONS = "Args|Parameters|Attributes|Returns|Yields|Raises|Notes|References|Examples?"
#: Sections of text, not of entries.
TEXTS = ("Notes", "References", "Example", "Examples")

_LINK = re.compile(r"\](?:\((?!https?:|#)([\w./-]+))")
_CODE = re.compile(r"(?<!`)(`{1,2})(?!`)(.+?)(?<!`)\1(?!`)")
_OWN = re.compile(rf"(?:{'|'.join(PACKAGES)})(?:\.[A-Za-z]\w*)+")
_HEAD = re.compile(rf"({SECTIONS})(:|\s*\n-+)\s*(?=\n|$)")
_ENTRY = re.compile(r"[\w.]+(?: \([^)]*\))?(?: \[[^]]*\])?(?:, [\w.]+(?: \[[^]]*\])?)* ?: ")
_ARRAY = re.compile(r"~?numpy\.ndarray\[.*?, ~?numpy\.dtype\[~?numpy\.(\w+)\]\]")


def process_docstring(app, what, name, obj, options, lines):
    """Replace the lines of a docstring in place (Sphinx's event)."""
    lines[:] = as_rst("\n".join(lines)).split("\n")


def process_signature(app, what, name, obj, options, signature, returns):
    """Name arrays NDArray[float64] and not by their class with its two parameters (Sphinx's event).

    A default that is created for every value becomes "...": Sphinx reads signatures as Python.
    """
    if signature:
        signature = re.sub(r"<[^<>]*>", "...", signature)
    return tuple(
        text and _ARRAY.sub(r"~numpy.typing.NDArray[~numpy.\1]", text) for text in (signature, returns)
    )


def process_included(app, path, parent, content):
    """Let links of a page that another one shows lead where they led (Sphinx's event)."""
    content[0] = _LINK.sub(lambda link: f"]({_seen_from_here(link[1])}", content[0])


def _seen_from_here(target: str) -> str:
    """Return a file of the repository, named from its root, as a page of this folder names it."""
    pages = {"README.md": "overview.md", "CONTRIBUTING.md": "contributing.md"}
    return pages.get(target) or (
        target.removeprefix("docs/") if target.startswith("docs/") else f"../{target}"
    )


def as_rst(text: str) -> str:
    """Return a docstring as reStructuredText that renders as what it reads."""
    found = []
    for block in re.split(r"\n\s*\n", text.strip("\n")):
        if not block.strip():
            continue
        if head := _HEAD.match(block):
            found.append(f"**{head[1]}**")
            block = textwrap.dedent(block[head.end() :].strip("\n"))
        if block.startswith((" ", ">>>")):
            found.append("::\n\n" + textwrap.indent(textwrap.dedent(block), "    "))
        elif head:
            found += _entries(block, names="---" in head[2] and head[1] not in TEXTS)
        else:
            found.append(_line(block))
    return "\n\n".join(found) + "\n"


def _entries(body: str, *, names: bool) -> list[str]:
    """Return the entries of a section, each a list item; a line that names nothing goes on, unless all lines
    that are not indented are `names`."""
    items: list[list[str]] = []
    for line in body.split("\n"):
        if items and (line.startswith(" ") or not (names or _ENTRY.match(line))):
            items[-1].append(line)
        else:
            items.append([line])
    items = [[f"{item[0]}.", *item[1:]] if names and len(item) > 1 else item for item in items]
    return [f"- {_item(chr(10).join(item))}" for item in items]


def _item(text: str) -> str:
    """Return an entry with its names set as code."""
    entry = _ENTRY.match(text)
    names = entry[0].rstrip(": ") if entry else ""
    return f"``{names}``: {_line(text[entry.end() :])}" if entry else _line(text)


def _line(text: str) -> str:
    """Return a paragraph in one line, its code set as code or as a reference and the rest escaped."""
    flat = " ".join(text.split())
    parts, end = [], 0
    for code in _CODE.finditer(flat):
        parts += [_escaped(flat[end : code.start()]), _code(code[2])]
        end = code.end()
    return "".join([*parts, _escaped(flat[end:])])


def _code(text: str) -> str:
    own = _OWN.fullmatch(text)
    return rf"\ :py:obj:`{text}`\ " if own else rf"\ ``{text}``\ "


def _escaped(text: str) -> str:
    return re.sub(r"([\\*|`]|_(?!\w))", r"\\\1", text)
