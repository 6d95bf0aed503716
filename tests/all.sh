#!/usr/bin/env bash
# Runs every check and test of the project; installs what they need first, if it is missing.
#
#   bash tests/all.sh
#
# Everything is built once, in the profile `fast`, which is optimized like the release but compiles in
# parallel. The seconds of each step are printed.
#
# Installs Debian or Ubuntu packages as root or by sudo. Exit code 0 if all passed, 2 if something is
# missing that it cannot install, else that of the step that failed.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=()
name="" began=$SECONDS

# Ends a step, prints its time, and begins the next one.
step() {
    if [[ $name ]]; then
        seconds+=("$(printf '%5d s  %s' "$((SECONDS - began))" "$name")")
        printf '(%d s)\n' "$((SECONDS - began))"
    fi
    name=$1 began=$SECONDS
    printf '\n=== %s\n' "$name"
}

# Notes a package as missing unless the check that follows it passes.
missing=()
need() {
    local package=$1
    shift
    "$@" >/dev/null 2>&1 || missing+=("$package")
}

step "tools"
command -v cargo >/dev/null || {
    echo "error: cargo is not on the PATH; install Rust 1.89 or newer (rustup)" >&2
    exit 2
}
need gmsh command -v gmsh
need python3-dolfinx /usr/bin/python3 -c 'import dolfinx.fem.petsc'
need python3-pytest /usr/bin/python3 -c 'import pytest'
# The reference BLAS makes the finite elements several times slower.
need libopenblas0-serial test -e /usr/lib/"$(uname -m)"-linux-gnu/openblas-serial/libblas.so.3
need openmpi-bin command -v mpirun
need calculix-ccx command -v ccx
need gcc command -v cc
need python3-venv /usr/bin/python3 -c 'import ensurepip'
# The page is tested in a real browser.
need chromium command -v chromium
# The fields are read by VTK's own reader.
need python3-vtk9 /usr/bin/python3 -c 'import vtkmodules.vtkIOXML'
if ((${#missing[@]})); then
    echo "to be installed: ${missing[*]}"
    as_root=()
    if [[ $(id -u) != 0 ]]; then
        as_root=(sudo -n)
    fi
    if ! command -v apt-get >/dev/null || ! "${as_root[@]}" true 2>/dev/null; then
        echo "error: this needs apt-get, and root or sudo without a password; install by hand:" \
            "${missing[*]}" >&2
        exit 2
    fi
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi
# The interpreter's cache beside the sources would make cargo build anew.
export PYTHONDONTWRITEBYTECODE=1

# Tests whose tools are installed, or whose rights are given, must not be skipped.
export EDGELINE_REQUIRE_BROWSER=1 EDGELINE_REQUIRE_VTK=1
if [[ $(id -u) == 0 ]]; then
    export EDGELINE_REQUIRE_MOUNT=1
fi

step "format, and the lines that tests/mutate.sh changes"
cargo fmt --all --check
bash tests/mutate.sh --fit

# The finite-element side needs one core and nothing that is built: its tests run beside the builds.
mkdir -p target
fem_log=target/fem-tests.log
/usr/bin/python3 -m pytest -q -p no:cacheprovider fem >"$fem_log" 2>&1 &
fem_tests=$!
# What the last steps need from PyPI comes beside the builds, too; what failed to come is tried again there.
(bash tests/python.sh --tools; bash tests/site.sh --tools) >target/tools.log 2>&1 &
tools=$!
trap 'kill "$fem_tests" "$tools" 2>/dev/null || true' EXIT

step "lints"
cargo clippy --profile fast --workspace --all-targets --quiet -- -D warnings

step "the library without the program"
cargo check --profile fast --lib --no-default-features --quiet
crates=$(cargo tree --no-default-features -e normal --prefix none --no-dedupe | sort -u | wc -l)
if ((crates > 60)); then
    echo "error: the library alone takes $crates crates, more than 60" >&2
    exit 1
fi

step "the package, as a registry would get it"
# The archive of another version would be left there.
rm -rf target/package
cargo package --package edgeline --allow-dirty --no-verify --quiet
unpacked=target/package/unpacked
mkdir -p "$unpacked"
tar -xzf target/package/edgeline-[0-9]*.crate --strip-components=1 -C "$unpacked"
# Against the crates that the lints have checked.
CARGO_TARGET_DIR=$PWD/target cargo check --profile fast --quiet --manifest-path "$unpacked/Cargo.toml"

step "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --profile fast --no-deps --quiet

step "licences and sources of dependencies"
if command -v cargo-deny >/dev/null; then
    cargo deny check licenses bans sources
else
    echo "skipped: cargo-deny is not installed; continuous integration runs it"
fi

step "the program and all tests are built"
cargo test --profile fast --no-run --quiet

step "installed tools, as the program sees them"
target/fast/edgeline doctor --fem

step "accuracy gates"
target/fast/edgeline gate --out target/gate

step "tests of the finite-element side, begun beside the builds"
status=0
wait "$fem_tests" || status=$?
cat "$fem_log"
((status == 0)) || exit "$status"

step "tests, those with live finite elements included"
cargo test --profile fast -- --include-ignored

step "the Python package"
wait "$tools" || true
bash tests/python.sh

step "the site of the documentation"
bash tests/site.sh

step "done"
printf '%s\n' "${seconds[@]}"
