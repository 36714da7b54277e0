"""What a user reads has the project's words: one word for one thing, and none that a native engineer would not use."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2] / "src" / "flexlash"

FORBIDDEN = {
    r"\bmend(s|ed|ing)?\b": "fix (of cells), change (of the design)",
    r"\bof its list\b": "what it is: a material, a unit, a choice",
    r"\balike\b": "identical, equal, together, or the names",
    r"\ball but\b": "the share itself, such as 99.99989 %",
    r"\bhardly\b": "barely, almost no",
    r"\breckon": "calculate",
    r"\bof which\b": "whose, or a sentence of its own",
    r"\bas one says\b": "nothing",
    r"\bcannot be told\b": "cannot be known, decoded, read",
    r"\b(is|are) told\b": "is reported, given, said",
    r"\bstands in\b": "is in",
    r"\blines of the same\b": "more",
    r"\bcannot know which holds\b": "cannot know which one applies",
    r"\bwithout a word\b": "silently",
    r"\bis no (file|number|limit|address|grade|report)\b": "is not a …",
    r"\binformations\b": "notes",
    r"\bgray\b": "grey",
    r"\bMind:": "Note:",
    r"\bvery file\b": "file",
    r"\bnone to all\b": "0 to 100 %",
    r"\balone can:": "is enough",
    r"\bentry of the list\b": "one of these",
}
"""Words that no message, sheet, page or help has, by the words to write instead."""

_ALLOWED = re.compile(r"-mended\b")
"""The ending of fixed files before version 0.10, by which they are still known."""


def _code_and_docstrings(tree: ast.Module) -> set[int]:
    """Return the identities of string constants that are no text for users: bare strings and most docstrings.

    The docstring of a command is its help.
    """
    hidden = {
        id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    return hidden - {id(node.body[0].value) for node in ast.walk(tree) if _is_command(node)}


def _is_command(node: ast.AST) -> bool:
    """Whether a node is a function that click calls as a command."""
    return isinstance(node, ast.FunctionDef) and any(
        re.match(r"click\.(command|group)\b", ast.unparse(one)) for one in node.decorator_list
    )


def _texts() -> Iterator[tuple[str, str]]:
    """Yield every text of more than one word that may be shown, with its place."""
    for path in sorted(SOURCE.rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        hidden = _code_and_docstrings(tree)
        for node in ast.walk(tree):
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in hidden:
                yield f"{path.relative_to(SOURCE)}:{node.lineno}", node.value
    for path in sorted(SOURCE.rglob("*.html")):
        text = re.sub(r"{%.*?%}|{{.*?}}|<[^>]*>", " ", path.read_text(encoding="utf-8"), flags=re.DOTALL)
        yield str(path.relative_to(SOURCE)), text
    for path in sorted((SOURCE / "schema" / "tables").glob("*.csv")):
        yield str(path.relative_to(SOURCE)), path.read_text(encoding="utf-8")


def _offences(place: str, text: str) -> Iterator[str]:
    """Yield each forbidden word of a text; a name without a space is code."""
    if " " not in text.strip():
        return
    for pattern, instead in FORBIDDEN.items():
        for match in re.finditer(pattern, _ALLOWED.sub("", text), flags=re.IGNORECASE):
            yield f"{place}: {match[0]!r}, write {instead}"


def test_every_text_has_the_words_of_the_project():
    """No string of the source, template of the page or example of a finding has a forbidden word."""
    assert [offence for place, text in _texts() for offence in _offences(place, text)] == []


def test_the_guard_sees_what_it_forbids():
    """Each forbidden word is found in a sentence, and names of code are left alone."""
    assert len(list(_offences("x", "How to mend it: all but 3 are alike."))) == 3
    assert list(_offences("x", "mended")) == list(_offences("x", "a name such as a-mended.xlsx")) == []


def test_the_help_of_commands_is_read():
    """The docstring of a command is what its help says; that of another function is for programmers."""
    command = '@click.command()\ndef a():\n    """Help of a."""\n'
    tree = ast.parse(f'{command}def b():\n    """Return b."""\n')
    texts = {id(node): node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    assert [text for key, text in texts.items() if key not in _code_and_docstrings(tree)] == ["Help of a."]
