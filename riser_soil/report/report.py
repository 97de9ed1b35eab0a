"""Reports of runs: from a report file to its document, and to HTML, PDF or Word by the file's ending."""

from __future__ import annotations

from collections.abc import Callable
from datetime import date
from importlib import import_module
from pathlib import Path

from riser_soil import __version__
from riser_soil.errors import ResultsError
from riser_soil.plots.progress import OnProgress, silent
from riser_soil.report import (
    basis,
    code_checks,
    fatigue_chapter,
    modes_chapter,
    quality,
    reproduction,
    response,
    sensitivity,
    statics,
    summary_chapter,
)
from riser_soil.report.document import PictureBlock, ReportCover, ReportDocument, ReportSection, numbered
from riser_soil.report.html import Began
from riser_soil.report.report_file import ReportFile
from riser_soil.report.sources import LoadCase, Sources, opened
from riser_soil.results.stage_records import stage_records
from riser_soil.results.whole_file import require_folder_of, written_whole

WRITERS = {  # by a file's ending: module, function, the package that it needs beside those of all reports
    ".html": ("riser_soil.report.html", "write_html", ""),
    ".htm": ("riser_soil.report.html", "write_html", ""),
    ".pdf": ("riser_soil.report.pdf", "write_pdf", "weasyprint"),
    ".docx": ("riser_soil.report.word", "write_word", "docx"),
}
Chapter = Callable[[Sources], ReportSection]
CHAPTERS: tuple[Chapter, ...] = (
    summary_chapter.chapter,
    basis.chapter,
    statics.chapter,
    response.chapter,
    code_checks.chapter,
    fatigue_chapter.chapter,
    sensitivity.chapter,
    modes_chapter.chapter,
    quality.chapter,
    reproduction.chapter,
    reproduction.appendix,
)


def write_report(given: ReportFile, file: Path, on_progress: OnProgress = silent) -> Path:
    """Write a report, in the format of the file's ending. on_progress: hears of each picture.

    Raises ResultsError where a folder holds no results, nothing was recorded, or the ending is of no format; the file
    is then as it was.
    """
    write = writer_of(file)
    require_folder_of(file)  # before anything is drawn
    document = document_of(opened(given))
    count = sum(isinstance(item, PictureBlock) for item in numbered(document))
    begun = 0

    def began(item: PictureBlock) -> None:
        nonlocal begun
        on_progress(item.caption.partition(":")[0], begun, count)
        begun += 1

    with written_whole(file) as part:
        write(document, part, began)
    return file


def document_of(sources: Sources) -> ReportDocument:
    """The report's document; chapters of what isn't there are not in it."""
    _refuse_stage(sources)
    return ReportDocument(_cover(sources), [section for chapter in CHAPTERS if (section := chapter(sources))])


def writer_of(file: Path) -> Callable[[ReportDocument, Path, Began], None]:
    """The writer of files with this ending; ResultsError where that is of no format, or its package is not there."""
    if file.suffix.lower() not in WRITERS:
        raise ResultsError(f"{file}: a report is one of {', '.join(WRITERS)}; change its ending")
    module, function, needed = WRITERS[file.suffix.lower()]
    try:
        if needed:
            import_module(needed)
        writer: Callable[[ReportDocument, Path, Began], None] = getattr(import_module(module), function)
    except (ImportError, OSError) as err:  # OSError: a library of the system that the package loads
        reason = " ".join(str(err).split())[:200]
        raise ResultsError(
            f"{file}: a {file.suffix} file needs {needed or err}, which cannot be loaded ({reason}); install "
            "riser_soil[report] and, for PDF, Pango (Debian: libpangoft2-1.0-0), or write an .html file"
        ) from err
    return writer


def _refuse_stage(sources: Sources) -> None:
    """ResultsError for a load step that no case has."""
    stage = sources.given.stage
    if stage is None:
        return
    for case in sources.cases:
        if _has(case, stage):
            return
    stage_records(sources.first.run, stage)


def _has(case: LoadCase, stage: str) -> bool:
    return any(each["name"] == stage for each in case.stages)


def _cover(sources: Sources) -> ReportCover:
    given = sources.given
    titles = dict.fromkeys(case.run.summary["title"] for case in sources.cases)
    return ReportCover(
        title=given.title or next(iter(titles)),
        subtitle=given.subtitle,
        client=given.client,
        document=given.document,
        revision=given.revision,
        date=given.date or date.today().isoformat(),
        authors=", ".join(given.authors),
        checked=given.checked,
        approved=given.approved,
        program=f"riser_soil {__version__}",
        logo=given.logo,
    )
