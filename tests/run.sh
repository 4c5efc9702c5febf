#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests. Extra arguments go to ctest.
set -euo pipefail
cd "$(dirname "$0")/.."
bash .ci/build.sh
exec ctest --test-dir build --output-on-failure --parallel "$(nproc)" "$@"
