#!/bin/bash
# Writes requirements/run-pins.txt and dev-pins.txt anew: the packages of run.txt and of dev.txt and all that they need, each
# at one version for a Python, from 3.11 on, that fits Debian's numpy and scipy (debian.txt), with the hashes of its files.
# Versions pinned before stay where they still fit.
#
#   scripts/pin.sh --upgrade                  takes the newest ones instead
#   scripts/pin.sh --upgrade-package NAME     takes the newest one of a package
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
tools=build/pin
linux="sys_platform == 'linux'" # pyproject.toml asks for no other; so it need not be said line by line

main() {
    [ -x $tools/bin/uv ] || { python3 -m venv $tools && $tools/bin/pip install --quiet uv==0.13.9; }
    resolved run -c requirements/debian.txt requirements/run.txt "$@"
    local already
    mapfile -t already < <(sed -n 's/^\([a-z][a-z0-9-]*\)==.*/--no-emit-package=\1/p' requirements/run-pins.txt)
    resolved dev -c requirements/debian.txt -c requirements/run-pins.txt \
        requirements/run.txt requirements/dev.txt "${already[@]}" "$@"
}

resolved() { # run or dev, arguments of the resolver
    local file=requirements/$1-pins.txt
    shift
    $tools/bin/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes --no-header --no-annotate \
        --no-emit-package=numpy --no-emit-package=scipy --no-emit-package=cffi --no-emit-package=pycparser --output-file "$file" "$@" >/dev/null
    sed -i -e "/^#/d; /^$/d" -e "s/ and $linux//; s/ ; $linux//" "$file"
    sed -i "1i # Written by scripts/pin.sh from the lists beside this file." "$file"
}

main "$@"
