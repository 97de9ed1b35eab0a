#!/bin/bash
# Builds the site of the project's pages, build/site: what git has of the project is laid out in build/pages as it lies here, so that links hold.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
rm -rf build/pages
mkdir -p build/pages
git ls-files --cached --others --exclude-standard -z -- '*.md' LICENSE CITATION.cff demos docker docs benchmarks meshes requirements riser_soil scripts tests \
    | tar --create --null --files-from=- | tar --extract --directory=build/pages
NO_MKDOCS_2_WARNING=1 .venv/bin/python -m mkdocs build "$@"
