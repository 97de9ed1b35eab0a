"""Tables in Markdown and their places in a demo's page."""

import pytest

from demos.page import block, csv_table, filled, table

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
