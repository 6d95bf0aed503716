#!/usr/bin/env bash
# Builds the Python package and tests it in a virtual environment of its own, target/python.
#
#   bash tests/python.sh [--tools]
#
# What the package, its tests and its build need comes from PyPI, once; with --tools nothing else is done. The
# tests compare with the program target/fast/edgeline, which must be built. Exit code 2 if something cannot be
# had, else that of the tests.
set -euo pipefail
cd "$(dirname "$0")/.."
home=target/python
python=$home/bin/python

# A virtual environment knows by this what it was made for.
wanted=$(cat python/pyproject.toml; /usr/bin/python3 --version)
if [[ $(cat $home/made-for 2>/dev/null) != "$wanted" ]]; then
    rm -rf $home
    /usr/bin/python3 -m venv $home || {
        echo "error: there is no virtual environment to be had; install python3-venv" >&2
        exit 2
    }
    mapfile -t packages < <(/usr/bin/python3 - <<'PYTHON'
import tomllib

with open("python/pyproject.toml", "rb") as file:
    wanted = tomllib.load(file)
project = wanted["project"]
print(*wanted["build-system"]["requires"], *project["dependencies"], sep="\n")
print(*project["optional-dependencies"]["test"], sep="\n")
PYTHON
    )
    $python -m pip install --quiet --disable-pip-version-check "${packages[@]}" || {
        echo "error: PyPI cannot be reached or lacks a package (see above); the Python package's tests need" \
            "${packages[*]}: make PyPI or a mirror (PIP_INDEX_URL) reachable, then run again" >&2
        exit 2
    }
    echo "$wanted" >$home/made-for
fi

if [[ ${1-} == --tools ]]; then
    exit
fi

rm -rf $home/wheels
$python -m maturin build --quiet --profile fast --manifest-path python/Cargo.toml \
    --interpreter $python --out $home/wheels
$python -m pip install --quiet --no-deps --force-reinstall $home/wheels/*.whl
$home/bin/pytest python/tests
