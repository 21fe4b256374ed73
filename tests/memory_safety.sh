#!/usr/bin/env bash
# The Embree layer and the SIMD traversal under tools that see wrong memory accesses. Needs a nightly compiler for the sanitizer,
# valgrind, and runs Miri where the toolchain has it. About ten minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."

host=$(rustc -vV | sed -n 's/^host: //p')
target=${CARGO_TARGET_DIR:-target}/memory-safety
failed=0
check() {
    local name=$1
    shift
    if "$@" >"$target.log" 2>&1; then
        echo "holds: $name ($(grep -c '^test .* ok$' "$target.log") tests)"
    else
        tail -40 "$target.log"
        echo "BROKEN: $name"
        failed=1
    fi
}

mkdir -p "$(dirname "$target")"
# Leaks are not looked for: Embree's thread pool keeps its memory to the end of the process.
for tests in "--test visibility" "--lib visibility::"; do
    # shellcheck disable=SC2086 # two words
    check "address sanitizer: $tests" \
        env RUSTFLAGS=-Zsanitizer=address ASAN_OPTIONS=detect_leaks=0 CARGO_TARGET_DIR="$target" \
        cargo +nightly test --target "$host" $tests
done

binary=$(cargo test --no-run --lib 2>&1 | sed -n 's/^ *Executable .*(\(.*\))$/\1/p')
check "valgrind: --lib visibility::" \
    valgrind --quiet --error-exitcode=9 --leak-check=no "$binary" --test-threads=1 visibility::

if cargo +nightly miri --version >/dev/null 2>&1; then
    check "Miri: geometry, form factors, mesh" \
        env CARGO_TARGET_DIR="$target/miri" MIRIFLAGS=-Zmiri-disable-isolation EMBREE_DIR=none \
        cargo +nightly miri test --lib -- geometry form_factor mesh
else
    echo "not run: Miri, which this toolchain does not have"
fi
exit $failed
