#!/bin/bash
# Compiles the kernels of some scenes of demos, of all kinds of parts, so that their first runs start at once.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scenes=(first_scene.yaml steel_catenary.yaml waves/scene.yaml lines/lazy_s.yaml touchdown_clay/scene.yaml)
exec .venv/bin/python -m riser_soil compile "${scenes[@]/#/demos/}"
