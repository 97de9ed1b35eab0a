#!/bin/bash
# Makes everything riser_soil needs: Debian packages, the environment .venv, and riser_soil itself in it.
# A second call finds the stamp of the first, looks whether all modules are still there, and does nothing.
#
#   scripts/setup.sh                 all that is needed to run riser_soil, to test it and to work on it
#   scripts/setup.sh dependencies    what a run needs, without riser_soil itself; this file and requirements/ are enough
#   scripts/setup.sh project         riser_soil itself, where its dependencies are
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
venv=$root/.venv
logs=$root/build/setup
python=/usr/bin/python3 # the system's: another python3 on the PATH does not see Debian's dolfinx

debian_packages=(
    python3 python3-venv python3-setuptools python3-wheel
    python3-dev gcc g++ # dolfinx compiles its forms when a run starts
    python3-dolfinx python3-dolfinx-real python3-petsc4py-real python3-mpi4py openmpi-bin
    python3-gmsh python3-numpy python3-scipy python3-h5py python3-h5py-mpi
    libopenblas0-serial # without it MUMPS falls back to the reference BLAS, seven times slower
    libegl1 libegl-mesa0 libgl1-mesa-dri # pictures without a display
    python3-cffi libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0 fonts-dejavu-core # reports as PDF
)
test_packages=(
    chromium-headless-shell # opens the pages that riser_soil writes
)
run_modules=(
    dolfinx petsc4py mpi4py gmsh numpy scipy h5py numba pydantic typer rich ruamel.yaml h5netcdf pyvista matplotlib jinja2 weasyprint docx raschii
)
dev_modules=(pytest xdist hypothesis xarray meshio ruff mypy)

main() {
    export LC_ALL=C.UTF-8
    unset PYTHONHOME PYTHONPATH PIP_USER PIP_TARGET PIP_PREFIX
    if ! command -v apt-get >/dev/null; then
        echo "set-up: riser_soil takes dolfinx and PETSc from Debian's packages, and there is no apt-get here." >&2
        echo "        Use Debian 12 or newer, or the image of docker/Dockerfile." >&2
        exit 1
    fi
    mkdir -p "$logs" && exec 9>"$logs/lock" || exit 1
    flock 9 # two set-ups at once would break each other's environment
    case ${1:-all} in
        all) debian_packages+=("${test_packages[@]}"); set_up_all ;;
        dependencies) set_up_dependencies run ;;
        project) set_up_project "${run_modules[@]}" ;;
        *)
            echo "set-up: \"$1\" is unknown; give dependencies, project or nothing, for both and what tests need" >&2
            exit 2
            ;;
    esac
}

set_up_all() {
    if is_complete; then
        echo "set-up: nothing to do"
        return
    fi
    set_up_dependencies run dev
    set_up_project "${run_modules[@]}" "${dev_modules[@]}"
    fingerprint >"$venv/stamp"
    echo "set-up: done in $SECONDS s"
}

set_up_dependencies() { # lists of pins
    step debian "Debian packages" install_debian_packages
    step venv "environment .venv on $python" make_venv
    step packages "Python packages at pinned versions" install_python_packages "$@"
}

set_up_project() { # modules that must be there
    step project "riser_soil itself" install_project
    step check "check that everything imports" check_imports "$@" riser_soil
}

step() { # name, title, function and its arguments: runs it with its output in a log, of which a failure shows the end
    local log=$logs/$1.log started=$SECONDS
    echo "set-up: $2 ..."
    ( set -e; "${@:3}" ) >"$log" 2>&1 9>&-
    local status=$?
    if [ $status -ne 0 ]; then
        echo "set-up: FAILED at the step \"$2\" after $((SECONDS - started)) s. Last lines of $log:" >&2
        tail -n 15 "$log" | sed 's/^/    /' >&2
        exit 1
    fi
    echo "set-up: $2: $((SECONDS - started)) s"
}

is_complete() {
    [ -x "$venv/bin/python" ] && [ -f "$venv/stamp" ] && [ "$(fingerprint)" = "$(cat "$venv/stamp")" ] \
        && [ -z "$(missing_debian_packages)" ] && modules_present
}

fingerprint() { # what the environment was made from
    origin
    {
        dpkg_state
        cat "$root"/scripts/setup.sh "$root"/requirements/*.txt
        sed '/^\[tool\.ruff/,$d' "$root/pyproject.toml"
    } | sha256sum
}

origin() { # an environment serves one place (scripts in .venv/bin hold the path) and one Python
    echo "$root"
    "$python" --version
}

modules_present() {
    "$venv/bin/python" -c 'import sys; from importlib.util import find_spec
sys.exit(not all(find_spec(name) for name in sys.argv[1:]))' "${run_modules[@]}" "${dev_modules[@]}" riser_soil 2>/dev/null
}

missing_debian_packages() {
    printf '%s\n' "${debian_packages[@]}" | sort | comm -23 - <(dpkg_state | sed -n 's/ installed .*//p' | sort -u)
}

dpkg_state() {
    dpkg-query -W -f='${Package} ${db:Status-Status} ${Version}\n' "${debian_packages[@]}" 2>/dev/null
}

install_debian_packages() {
    local missing as_root=()
    mapfile -t missing < <(missing_debian_packages)
    [ ${#missing[@]} -gt 0 ] || return 0
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "These Debian packages are missing, and installing them takes root or sudo: ${missing[*]}"
            echo "As root:  apt-get install --no-install-recommends ${missing[*]}"
            return 1
        fi
        as_root=(sudo)
    fi
    "${as_root[@]}" apt-get update
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"
}

make_venv() {
    if venv_usable; then return; fi
    "$python" -m venv --clear --system-site-packages "$venv"
}

venv_usable() { # not when its set-up was interrupted, when it was moved, made with another Python, or lost modules since
    [ "$(cat "$venv/origin" 2>/dev/null)" = "$(origin)" ] || return 1
    [ "$(cat "$venv/stamp" 2>/dev/null)" != "$(fingerprint)" ] || return 1
    "$venv/bin/python" -m pip --version
}

install_python_packages() { # lists of pins
    local name files=()
    for name in "$@"; do files+=(-r "$root/requirements/$name-pins.txt"); done
    rm -f "$venv/origin" "$venv/stamp"
    # Nothing beyond the lists: another numpy than the one Debian's PETSc was compiled with does not load.
    "$venv/bin/python" -m pip install --disable-pip-version-check --no-deps --only-binary :all: --require-hashes \
        "${files[@]}"
    origin >"$venv/origin"
}

install_project() {
    "$venv/bin/python" -m pip install --disable-pip-version-check --no-deps --no-index --no-build-isolation -e "$root"
    "$venv/bin/python" -m compileall -q "$root/riser_soil" # a start reads bytecode, also where Python may not write it
}

check_imports() { # modules
    cd / && MPLBACKEND=Agg "$venv/bin/python" -c 'import importlib, sys
for name in sys.argv[1:]: importlib.import_module(name)' "$@" && return
    rm -f "$venv/origin"
    echo "The next set-up makes .venv afresh."
    return 1
}

main "$@"
