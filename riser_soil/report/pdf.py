"""Writer of a report as PDF: the HTML page, laid out on A4 by WeasyPrint with page numbers in its list of contents."""

from __future__ import annotations

import logging
from pathlib import Path

from riser_soil.report.document import ReportDocument
from riser_soil.report.html import Began, page_of


def write_pdf(document: ReportDocument, file: Path, began: Began) -> None:
    """Write the pages."""
    from weasyprint import HTML

    logging.getLogger("weasyprint").setLevel(logging.ERROR)
    HTML(string=page_of(document, began)).write_pdf(file)
