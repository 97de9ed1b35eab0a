#!/bin/bash
# Puts the programs of requirements/peers.txt into an environment of their own, build/peers, for `make bench-peers`, and
# CalculiX among Debian's packages.
# A second call finds them there and does nothing. A program that is not to be had is left out, and said so.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
asked=requirements/peers.txt
stamp=build/peers/asked.txt

if ! command -v ccx >/dev/null; then # CalculiX, as Debian has it
    as_root=()
    [ "$(id -u)" -eq 0 ] || as_root=(sudo)
    "${as_root[@]}" apt-get install -y --no-install-recommends calculix-ccx \
        || echo "calculix-ccx is not to be had here: it is left out"
fi
! cmp -s $asked $stamp || exit 0
echo "installing the programs of $asked into build/peers"
python3 -m venv --clear build/peers
grep -v '^#' $asked | while read -r program; do
    build/peers/bin/pip install --quiet "$program" || echo "$program is not to be had here: it is left out"
done
cp $asked $stamp
