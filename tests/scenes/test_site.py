"""The site of the project's pages: builds without a warning, and asks nothing of the network."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

from tests.support.on_ranks import ROOT


def test_site_builds_without_a_warning_and_needs_no_network(tmp_path: Path) -> None:
    done = subprocess.run([ROOT / "scripts/site.sh", "--site-dir", tmp_path], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    home = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert re.findall(r'<(?:script|img)[^>]* src="(?:https?:)?//|<link rel="stylesheet" href="http', home) == []
    assert "doc-heading" in (tmp_path / "docs/api/index.html").read_text(encoding="utf-8")
