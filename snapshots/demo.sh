#!/usr/bin/env bash
# Installs what is missing, builds, explores the embedded scene and says where the pictures are.
# Usage: bash snapshots/demo.sh [SCENE [OUTPUT_FOLDER]]
set -euo pipefail
cd "$(dirname "$0")/.."
scene=${1:-tabletop}
out=${2:-out/demo}
bash .ci/build.sh vantage
mkdir -p "$out"
build/bin/vantage explore "$scene" -o "$out/$scene.vantage" --snapshots "$out/$scene" --json "$out/$scene.json"
echo
echo "The run:      $out/$scene.vantage"
echo "The pictures: $out/$scene/ (start with $scene-sheet.png)"
