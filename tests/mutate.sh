#!/usr/bin/env bash
# Shows that the tests detect wrong formulas: changes one line of the kernels or the solver at a time,
# in a copy of the project, and runs the tests that should then fail.
#
#   bash tests/mutate.sh [--fit | WORD]
#
# With --fit, only checks that every line to be changed is there. With a word, only the mutants whose
# line below contains it: `gates` for the one that the accuracy gates should detect. The copy is in
# target/mutants. Exit code 0 if every mutant was detected, 1 if one survived, 2 if a mutant no longer
# fits its file or does not build, or if the tests fail without any.
set -euo pipefail
cd "$(dirname "$0")/.."
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$PWD/target}
copy=$CARGO_TARGET_DIR/mutants
mkdir -p "$copy"

solver="--test numerics -- verification fields"

# File, the text of the line, its replacement, the tests that should detect it and, if it matters, their
# message. A text must occur in its file exactly once.
mutants=(
    "src/kernels/boussinesq.rs @@ -1.5 / PI * z @@ -1.4 / PI * z @@ --lib kernels::boussinesq"
    "src/kernels/deflection.rs @@ (log(0) + log(1)) + x * difference @@ (log(0) + log(1)) - x * difference @@ --lib kernels::deflection"
    "src/kernels/hertz.rs @@ let zz = -lift * m * m_sum / modulus; @@ let zz = -lift * m * n_sum / modulus; @@ --test numerics -- line_contact"
    "src/kernels/plate.rs @@ along + (1.0 - near) * up @@ along + (1.0 + near) * up @@ --lib kernels::plate"
    "src/kernels/strip.rs @@ (potential(2 * m) - potential(2 * m + 2)) @@ (potential(2 * m) + potential(2 * m + 2)) @@ --lib kernels::strip"
    "src/body/finite.rs @@ difference.gemm(-1.0, left, right, 1.0); @@ difference.gemm(1.0, left, right, 1.0); @@ $solver"
    "src/body/finite.rs @@ .map(|i| Image { weight: 2.0 * i.weight, ..*i }) @@ .map(|i| Image { weight: i.weight, ..*i }) @@ $solver"
    "src/contact/solver.rs @@ => (problem.load / load, 0.0), @@ => (0.8 * problem.load / load, 0.0), @@ $solver"
    "src/contact/solver.rs @@ 2.0 * singular / slopes[j] @@ -2.0 * singular / slopes[j] @@ $solver"
    "src/kernels/strip.rs @@ [f + g, f - g, -h] @@ [f + g, f + g, -h] @@ gates @@ quarter-space .* NO .* depth-.* sigma_zz"
    "src/kernels/wave.rs @@ &mut sums.even[wave], times @@ &mut sums.even[0], times @@ --lib kernels::wave"
    "src/stress/round.rs @@ along * (1.0 - 2.0 * along) @@ along * (1.0 + 2.0 * along) @@ --lib stress::round"
    "src/stress/slow_change.rs @@ [z * sine - (1.0 @@ [z * sine + (1.0 @@ --lib stress::slow_change"
    "src/stress/waves.rs @@ let free = 1.0 - 2.0 * nu; @@ let free = 1.0 + 2.0 * nu; @@ $solver"
)

# Mutants are built with a little less optimisation. Cargo names what it builds by its options, too:
# with the same ones a mutant would take the place of what is built of the project itself.
mutated=(--config 'profile.fast.package.edgeline.opt-level=2')

# Builds the tests of a tree, quietly.
build() {
    local options=() tree=$1 wanted=(test --no-run "${@:2}")
    if [[ $tree != "$PWD" ]]; then
        options=("${mutated[@]}")
    fi
    if [[ $2 == gates ]]; then
        wanted=(build)
    fi
    (cd "$tree" && cargo "${options[@]}" "${wanted[@]}" --quiet --profile fast) >"$copy/log" 2>&1
}

# Builds and runs tests in a tree, quietly: those that cargo finds by these words, or the accuracy gates.
run() {
    local options=() tree=$1
    if [[ $2 == gates ]]; then
        build "$tree" gates && "$CARGO_TARGET_DIR/fast/edgeline" gate --out "$copy/gate" >"$copy/log" 2>&1
        return
    fi
    if [[ $tree != "$PWD" ]]; then
        options=("${mutated[@]}")
    fi
    (cd "$tree" && cargo "${options[@]}" test --quiet --profile fast "${@:2}") >"$copy/log" 2>&1
}

refuse() {
    echo "error: $1" >&2
    tail -20 "$copy/log" >&2 2>/dev/null || true
    exit 2
}

# The text that a mutant changes must be in one line of its file.
fits() {
    local count
    count=$(grep -cF -- "$2" "$1" || true)
    [[ $count == 1 ]] && return
    echo "error: $1 has $count lines with \"$2\": bring tests/mutate.sh up to date" >&2
    exit 2
}

if [[ ${1:-} == --fit ]]; then
    for mutant in "${mutants[@]}"; do
        rest=${mutant#* @@ }
        fits "${mutant%% @@ *}" "${rest%% @@ *}"
    done
    exit 0
fi

# The current state of all files under version control; unchanged files keep their times for cargo.
rm -rf "$copy/tree"
mkdir "$copy/tree"
git ls-files -z --deduplicate | xargs -0 cp --parents --preserve=timestamps --target-directory="$copy/tree"

declare -A known=()
checked=0
survived=0
for mutant in "${mutants[@]}"; do
    [[ $mutant == *"${1:-}"* ]] || continue
    file=${mutant%% @@ *} rest=${mutant#* @@ }
    from=${rest%% @@ *} rest=${rest#* @@ }
    to=${rest%% @@ *} rest=${rest#* @@ }
    tests=${rest%% @@ *} words=${rest#"$tests"}
    read -ra arguments <<<"$tests"
    if [[ -z ${known[$tests]:-} ]]; then
        run "$PWD" "${arguments[@]}" || refuse "these tests fail without a mutant: $tests"
        known[$tests]=1
    fi
    fits "$file" "$from"
    FROM=$from TO=$to perl -pi -e 's/\Q$ENV{FROM}\E/$ENV{TO}/' "$copy/tree/$file"
    read -ra built <<<"${tests%% -- *}"
    build "$copy/tree" "${built[@]}" || refuse "$file does not build with \"$to\""
    if run "$copy/tree" "${arguments[@]}" || ! grep -qE -- "${words# @@ }" "$copy/log"; then
        echo "SURVIVED  $file: $from -> $to"
        survived=1
    else
        echo "caught    $file: $from -> $to ($(grep -cE 'panicked at|  NO  ' "$copy/log") fail)"
    fi
    cp "$file" "$copy/tree/$file"
    checked=1
done
((checked)) || refuse "no mutant has \"${1:-}\""
exit "$survived"
