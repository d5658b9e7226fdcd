#!/usr/bin/env bash
# Runs a file of browser tests, or says why it cannot and ends with 77, which ctest takes for "skipped".
#
# use: run.sh SOURCE_FOLDER BUILD_FOLDER FILE
set -euo pipefail
source=$1 build=$2 file=$3

skip() {
  echo "SKIPPED: $1"
  exit 77
}
command -v node >/dev/null || skip "there is no node"
[[ -x $(command -v "${CHROMIUM:-chromium}") ]] || skip "there is no chromium; CHROMIUM=PATH names another place"
[[ -e $source/web/node_modules/playwright-core ]] || skip "there is no playwright-core: ./dev web installs it"
[[ -e $source/build/web/out/site/index.html ]] || skip "the site is not built: ./dev web builds it"

export CHROMIUM TUREEN_PROGRAMS=$build/bin TUREEN_EVIDENCE=$build/golden-variants
CHROMIUM=$(command -v "${CHROMIUM:-chromium}")
exec node --test --test-reporter=spec "$file"
