#!/usr/bin/env bash
# Fuzzes every reader with coverage guidance (libFuzzer) and the address sanitizer, from seeds made of the bundled scenes.
# Needs `cargo install cargo-fuzz` and a nightly compiler. What it finds lies in tests/fuzz/artifacts.
#
#   tests/fuzz/run.sh [SECONDS] [TARGET...]     60 s for each of scene, gltf, ply, solve, points and solution unless told otherwise
set -euo pipefail
cd "$(dirname "$0")/../.."

seconds=${1:-60}
shift $(($# > 0 ? 1 : 0))
targets=("${@:-scene}")
[ $# -gt 0 ] || targets=(scene gltf ply solve points solution)
corpus=${CARGO_TARGET_DIR:-target}/fuzz
mkdir -p "$corpus"/{scene,gltf,ply,solve,points,solution}

# A scene is its three files with NUL between them.
for folder in scenes/*/; do
    name=$(basename "$folder")
    { cat "$folder"/*.obj; printf '\0'; cat "$folder"/*.mtl; printf '\0'; sed 's/^geometry.*/geometry = "s.obj"/' "$folder/scene.toml"; } |
        sed 's/^mtllib.*/mtllib s.mtl/' >"$corpus"/scene/"$name"
done
cp tests/fuzz/seeds/scene/* "$corpus"/scene/
cp tests/fuzz/seeds/scene/* "$corpus"/solve/
cp tests/fuzz/seeds/points/* "$corpus"/points/
cp tests/fuzz/seeds/gltf/* "$corpus"/gltf/
cp tests/fuzz/seeds/ply/* "$corpus"/ply/
# A solution without its header, of 24 bytes.
if ! [ -e "$corpus"/solution/whole ]; then
    solved=$(mktemp -d)
    trap 'rm -rf "$solved"' EXIT
    head -c -1 tests/fuzz/seeds/scene/lamp | tr '\0' '\n' | sed -n '/^v\|^f\|^usemtl\|^mtllib/p' >"$solved/s.obj"
    printf 'newmtl lamp\nKe 1 1 1\nnewmtl floor\nKd 0.5 0.5 0.5\n' >"$solved/s.mtl"
    cargo run --quiet --release -- solve "$solved/s.obj" -o "$solved" --preset draft --max-depth 1 --no-pictures
    tail -c +25 "$solved/solution.rad" >"$corpus"/solution/whole
    cargo run --quiet --release -- solve "$solved/s.obj" -o "$solved" --preset draft --max-depth 1 --no-pictures --max-shots 1
    tail -c +25 "$solved/solution.rad" >"$corpus"/solution/begun
fi

for target in "${targets[@]}"; do
    echo "== $target: $seconds s"
    cargo +nightly fuzz run --fuzz-dir tests/fuzz "$target" "$corpus"/"$target" -- \
        -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 -max_len=20000 -close_fd_mask=3 -print_final_stats=1
done
