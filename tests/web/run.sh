#!/usr/bin/env bash
# Runs browser tests: a file of tests, or every.mjs. If it cannot, prints why and ends with 77, "skipped" for ctest.
#
# use: run.sh SOURCE_FOLDER BUILD_FOLDER FILE
set -euo pipefail
source=$1 build=$2 file=$3

skip() {
  echo "SKIPPED: $1"
  exit 77
}
command -v node >/dev/null || skip "node is not installed"
if [[ ! ${CHROMIUM-} ]]; then  # as in browser.mjs
  CHROMIUM=chromium
  ! command -v chromium-headless-shell >/dev/null || CHROMIUM=chromium-headless-shell
fi
[[ -x $(command -v "$CHROMIUM") ]] || skip "chromium is not installed; CHROMIUM=PATH sets another browser"
[[ -e $source/web/node_modules/playwright-core ]] || skip "playwright-core is not installed: run ./dev web"
[[ -e $source/build/web/out/site/index.html ]] || skip "the site is not built: run ./dev web"

export CHROMIUM TUREEN_PROGRAMS=$build/bin TUREEN_EVIDENCE=$build/golden-variants
CHROMIUM=$(command -v "$CHROMIUM")
exec node --test-reporter=spec "$file"
