"""Tables in Markdown and their places in a demo's page."""

import re
from pathlib import Path

import pytest

from demos.figures import QUICK
from demos.from_tables import table_figures
from demos.page import ROOT, all_pages, block, csv_table, filled, places, plain, table
from tests.support.pages import same_figures

VERIFIED = "".join(each.read_text(encoding="utf-8") for each in (ROOT / "tests/verification").glob("test_*.py"))
TOLD = [re.sub(r"{.*?}", ".+", name) for name in re.findall(r'\btell\(\{f?"(.*?)": ', VERIFIED)]  # by long tests
FIGURE = re.compile("<!-- figure ([^>]+) -->")
PAGE = "Before.\n\n<!-- one -->\n<!-- end of one -->\nBetween.\n<!-- two -->\nold\n<!-- end of two -->\n"


def test_table() -> None:
    assert table(["a", "b"], [["1", "2"]]) == "| a | b |\n| --- | ---: |\n| 1 | 2 |"


def test_table_as_csv() -> None:
    assert csv_table(["a", "b"], [["x, y", "2"]]) == 'a,b\n"x, y",2\n'


def test_blocks_are_filled_and_read() -> None:
    page = filled(filled(PAGE, {"one": "x\ny"}), {"one": "new", "two": "z"})
    assert (block(page, "one"), block(page, "two"), block(PAGE, "one")) == ("new", "z", "")
    assert page == PAGE.replace("one -->\n<!-- end of one", "one -->\nnew\n<!-- end of one").replace("old", "z")


def test_a_page_without_the_marks_is_refused() -> None:
    with pytest.raises(KeyError, match="three"):
        filled(PAGE, {"three": "x"})


def test_figures_within_sentences_are_filled_and_read() -> None:
    page = PAGE + "It is <!-- figure depth -->11.1<!-- end --> m deep, <!-- figure depth -->11.1<!-- end --> m.\n"
    assert places(page) == {"one": [""], "two": ["old"], "depth": ["11.1", "11.1"]}
    assert places(filled(page, {"depth": "12.0", "two": "new"})) == {"one": [""], "two": ["new"], "depth": ["12.0"] * 2}
    assert plain(page).endswith("It is 11.1 m deep, 11.1 m.\n")


@pytest.mark.parametrize(
    ("shown", "computed", "same"),
    [
        ("76.48 to 100.25 kN", "76.49 to 100.25 kN", True),
        ("76.46 to 100.25 kN", "76.48 to 100.25 kN", False),
        ("1,680 cells", "1681 cells", True),
        ("up to 1.0", "from 1.0", False),
        ("2.0", "2.0 and 3.0", False),
    ],
)
def test_figures_are_the_same_but_for_the_last_digit(shown: str, computed: str, same: bool) -> None:
    assert same_figures(shown, computed) is same


def test_sentences_of_the_demos_tell_what_their_tables_have() -> None:
    """`make figures` writes them anew, after the tables."""
    stated: dict[str, set[str]] = {}
    for page in all_pages():
        for name, texts in places(page.read_text(encoding="utf-8")).items():
            stated.setdefault(name, set()).update(texts)
    figures = table_figures()
    assert {name: stated[name] for name in figures} == {name: {text} for name, text in figures.items()}


def test_every_figure_in_a_sentence_has_a_script_or_a_test() -> None:
    for page in all_pages():
        script = page.parent / "run.py"
        own = script.read_text(encoding="utf-8") if script.exists() else ""
        for name in FIGURE.findall(page.read_text(encoding="utf-8")):
            known = name in table_figures() or name.startswith((*QUICK, "demo "))  # whose tests compare them with runs
            listed = any(re.fullmatch(each, name) for each in TOLD)
            assert known or listed or f'"{name}"' in own, f"{page}: {name} is written by no script"


@pytest.mark.parametrize("page", all_pages(), ids=lambda page: str(page.relative_to(ROOT)))
def test_no_line_begins_with_the_mark_of_a_figure(page: Path) -> None:
    """Markdown would take the line for HTML, and end the paragraph there."""
    assert re.findall(r"^[ >*-]*<!-- figure .*$", page.read_text(encoding="utf-8"), re.MULTILINE) == []
