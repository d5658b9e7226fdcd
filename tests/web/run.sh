#!/usr/bin/env bash
# Runs a file of browser tests. If it cannot, prints why and ends with 77, "skipped" for ctest.
#
# use: run.sh SOURCE_FOLDER BUILD_FOLDER FILE
set -euo pipefail
source=$1 build=$2 file=$3

skip() {
  echo "SKIPPED: $1"
  exit 77
}
command -v node >/dev/null || skip "node is not installed"
[[ -x $(command -v "${CHROMIUM:-chromium}") ]] || skip "chromium is not installed; CHROMIUM=PATH sets another browser"
[[ -e $source/web/node_modules/playwright-core ]] || skip "playwright-core is not installed: run ./dev web"
[[ -e $source/build/web/out/site/index.html ]] || skip "the site is not built: run ./dev web"

export CHROMIUM TUREEN_PROGRAMS=$build/bin TUREEN_EVIDENCE=$build/golden-variants
CHROMIUM=$(command -v "${CHROMIUM:-chromium}")
exec node --test --test-reporter=spec "$file"
