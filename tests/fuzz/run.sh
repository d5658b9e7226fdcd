#!/bin/sh
# run.sh SOURCE SEEDS BUILD TARGET SECONDS [CORPUS]: replays the known inputs of a target (seeds, crashes, and
# the corpus of ./dev fuzz in BUILD/corpus), then fuzzes it. It adds new inputs to the folder CORPUS, if given,
# and writes a crash into BUILD/crashes/TARGET.
set -eu
source=$1 seeds=$2 build=$3 target=$4 seconds=$5
here=$source/tests/fuzz
program=$build/bin/fuzz_$target
[ -x "$program" ] || { echo "no $program: ./dev fuzz $target builds it"; exit 1; }

crashes=$build/crashes/$target
corpus=${6:-}
if [ -z "$corpus" ]; then
  corpus=$(mktemp -d)
  trap 'rm -r "$corpus"' EXIT
fi
known=$here/crashes/$target
mkdir -p "$corpus" "$crashes"
[ -d "$known" ] || known=$seeds/$target
collected=$build/corpus/$target
[ -d "$collected" ] || collected=$seeds/$target

# The memory limit of readers is 32 MB here (entry.cpp); sanitizers need several times that. Reading
# kilobytes takes milliseconds.
limits="-malloc_limit_mb=100 -rss_limit_mb=1024 -timeout=20 -print_final_stats=1"
export ASAN_OPTIONS="allocator_may_return_null=1:detect_leaks=1"
# shellcheck disable=SC2086 -- options without blanks
"$program" $limits -artifact_prefix="$crashes/" -runs=0 "$seeds/$target" "$known" "$collected"
# shellcheck disable=SC2086
"$program" $limits -artifact_prefix="$crashes/" -dict="$here/dictionaries/$target.dict" \
  -max_len=16384 -max_total_time="$seconds" "$corpus" "$seeds/$target" "$known"
