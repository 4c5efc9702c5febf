#!/usr/bin/env bash
# Remakes the pictures of README.md with the program itself. Usage: bash snapshots/gallery.sh [VANTAGE]
set -euo pipefail
cd "$(dirname "$0")/.."
vantage=${1:-build/bin/vantage}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$vantage" explore tabletop -o "$work/tabletop.vantage" --quiet
mkdir -p snapshots/gallery
for recipe in segments views; do
  "$vantage" snapshot "$work/tabletop.vantage" --step 1 --recipe "$recipe" -o "snapshots/gallery/$recipe.png" --quiet
done
for recipe in counted poses; do
  "$vantage" snapshot "$work/tabletop.vantage" --step 1 --recipe "$recipe" --size 800x500 \
    -o "snapshots/gallery/$recipe.png" --quiet
done
"$vantage" view "$work/tabletop.vantage" --picture snapshots/gallery/inspector.png --quiet
"$vantage" explore tabletop --planner hierarchical --steps 1 -o "$work/octree.vantage" --quiet
for recipe in octree rays utility; do
  "$vantage" snapshot "$work/octree.vantage" --step 1 --recipe "$recipe" --size 960x600 \
    -o "snapshots/gallery/$recipe.png" --quiet
done
