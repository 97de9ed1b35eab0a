"""README.md and the pages in docs: pieces of scenes fit into a scene, and what the pages point to is there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from riser_soil.core import outputs
from riser_soil.results.netcdf import SERIES
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from tests.support.on_ranks import ROOT
from tests.support.pages import DEMOS, DOCS, README, blocks, text
from tests.support.scenes import ON_SEABED, overlaid

PAGES = [README, *DOCS]
LIST = ROOT / "docs" / "README.md"
PLACES = "riser_soil|tests|demos|docker|benchmarks|meshes|scripts|requirements"


def matches_in(pattern: str, pages: list[Path]) -> list[Any]:
    """What a pattern with one group finds in pages, each once: page and finding."""
    return [
        pytest.param(page, what, id=f"{page.relative_to(ROOT)}: {what}")
        for page in pages
        for what in sorted(set(re.findall(pattern, text(page))))
    ]


def pieces(page: Path) -> Iterator[dict[str, Any]]:
    """The page's YAML blocks as data."""
    yield from (YAML(typ="safe").load(block) for block in blocks(page, "yaml"))


@pytest.mark.parametrize(("page", "n"), [(page, n) for page in DOCS for n, _ in enumerate(pieces(page))])
def test_pieces_of_scenes_are_valid(page: Path, n: int, tmp_path: Path) -> None:
    """With the tables that the page shows, each named in its first line."""
    for table in blocks(page, "csv"):
        (tmp_path / table.splitlines()[0].removeprefix("# ")).write_text(table, encoding="utf-8")
    scene_from_mapping(overlaid(ON_SEABED, list(pieces(page))[n]), tmp_path)


def test_the_tutorial_shows_lines_of_its_scene() -> None:
    scene = (ROOT / "demos/steel_catenary.yaml").read_text(encoding="utf-8").splitlines()
    (shown,) = blocks(ROOT / "docs/tutorial_riser.md", "yaml")
    assert [line for line in scene if line in shown.splitlines()] == shown.splitlines()


def anchors(page: Path) -> set[str]:
    """What links to a page may name in it: its headings."""
    headings = re.findall(r"^#+ (.+)$", text(page), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize(("page", "target"), matches_in(r"\]\(([^)]+)\)", [*PAGES, *DEMOS]))
def test_link(page: Path, target: str) -> None:
    path, _, anchor = target.partition("#")
    place = (page.parent / path).resolve() if path else page
    assert place.exists()
    assert not anchor or anchor in anchors(place)


@pytest.mark.parametrize(("page", "link"), matches_in(r"\[(test_\w+\]\([^)]+)\)", [*PAGES, *DEMOS]))
def test_a_test_that_is_named_is_there(page: Path, link: str) -> None:
    """A link whose text is a test's name leads to the file that has it."""
    name, path = link.split("](")
    assert re.search(rf"^def {name}\(", text(page.parent / path), re.MULTILINE)


def test_each_case_of_validation_names_its_test() -> None:
    rows = [row for row in text(ROOT / "docs/validation.md").splitlines() if row.count(" | ") == 3]
    cases = [row for row in rows if not row.startswith("| case |")]
    assert len(cases) > 50
    assert [row for row in cases if "| [test_" not in row] == []


@pytest.mark.parametrize(("page", "path"), matches_in(rf"`((?:{PLACES})/[\w/.]*)`", PAGES))
def test_path(page: Path, path: str) -> None:
    assert (ROOT / path).exists() or path == "demos/touchdown_clay/results"


def test_front_page_leads_to_the_list_of_all_others() -> None:
    assert f"]({LIST.relative_to(ROOT)})" in text(README)
    assert [page.name for page in DOCS if page != LIST and not _listed(page)] == []


def _listed(page: Path) -> bool:
    """In the list of all pages, or, in a folder, in the page of its name."""
    parts = page.relative_to(LIST.parent).parts
    of_list = LIST if len(parts) == 1 else LIST.parent / f"{parts[0]}.md"
    return f"]({'/'.join(parts)})" in text(of_list)


def test_the_index_of_what_tests_share_has_each_module_once() -> None:
    support = ROOT / "tests/support"
    named = re.findall(r"`(\w+)`", text(support / "README.md").partition("\n| for |")[2])
    assert sorted(named) == sorted(path.stem for path in support.glob("*.py"))


def test_layout_names_every_folder_and_module_of_the_package() -> None:
    package = ROOT / "riser_soil"
    folders = {f"`riser_soil/{place.parent.name}/`" for place in package.glob("*/__init__.py")}
    modules = {f"`riser_soil/{place.name}`" for place in package.glob("*.py") if place.name != "__init__.py"}
    table = text(ROOT / "docs/map.md").split("| place | content |")[1].split("\n\n")[0]
    assert {name for name in folders | modules if name not in table} == set()


def test_words_of_the_table_are_known() -> None:
    table = text(ROOT / "docs/conventions.md").split("| word | symbol | unit | meaning |")[1].split("\n\n")[0]
    words = {w for row in table.splitlines()[2:] for w in re.findall(r"\w+", row.split("|")[1]) if w != "or"}
    assert len(words) > 30
    assert words <= {*keys_of(Scene.model_json_schema(by_alias=True)), *SERIES, *outputs.choices()}


def keys_of(schema: Any) -> Iterator[str]:
    """All keys of the scene language."""
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
    values = schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ()
    for value in values:
        yield from keys_of(value)
