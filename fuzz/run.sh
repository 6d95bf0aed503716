#!/usr/bin/env bash
# Fuzzes every target, or those named, one after another.
#
#   bash fuzz/run.sh SECONDS [TARGET...]
#
# New inputs are collected in fuzz/work/, an input that is a finding in fuzz/artifacts/. Exit code 0 if
# there was none, else that of the fuzzer.
set -euo pipefail
cd "$(dirname "$0")"
seconds=${1:?"give the seconds of each target"}
shift
if (($# == 0)); then
    mapfile -t targets < <(basename -s .rs fuzz_targets/*.rs)
    set -- "${targets[@]}"
fi
for target in "$@"; do
    mkdir -p "work/$target" "corpus/$target"
    # The project's own files of this kind are inputs, too.
    own=()
    case $target in
        case | study) own=(../cases) ;;
        design | sweep) own=(../examples) ;;
        gates) own=(../src/study/gates) ;;
    esac
    echo "=== $target"
    # Nothing unsafe is reached here: without a sanitizer many more inputs are tried.
    cargo +nightly fuzz run --sanitizer none "$target" "work/$target" "corpus/$target" "${own[@]}" -- \
        -max_total_time="$seconds" -rss_limit_mb=2048 -timeout=20 -max_len=16384 \
        -dict=words.dict -print_final_stats=1
done
