#!/usr/bin/env bash
# Measures what docs/benchmarks.md holds. `./dev bench` builds what this needs and calls it, from the
# repository's root.
set -uo pipefail

bin=build/release/bin out=build/bench data=../shared/data
usual_parts=(load frames leave_out growth tradeoff slim agreement step browser)
all_parts=("${usual_parts[@]}" training)
quick='' processor='' check='' ficus='' fox='' photographs='' lego='' bottle=''
parts=() done_parts=() skipped=() failed=()

usage() {
  cat <<'END'
usage: ./dev bench [--quick] [--processor-time] [--ficus SOUP] [--fox SOUP]
                   [--photographs DATASET] [--lego DATASET] [--bottle DATASET] [PART..]

Measures and writes tables, plots and pages into build/bench; without a PART all but training:
  load        how long a soup of 2,000,000 triangles takes to load from each format, and its memory
  frames      tureen bench: frame times across sizes, on every scene there is
  leave_out   what each thing that a plan leaves out gains
  growth      the time of a frame against triangles, pixels and overdraw, and its model
  tradeoff    tureen tradeoff: error against run time, on every scene there is and over all of them
  slim        what tureen convert --slim makes of every soup there is
  agreement   how well GL agrees with the oracle
  step        what a training step costs
  browser     bench.html in Chromium on two rasterisers, memory, and how long the first picture takes
  training    the training runs: hours; the others then draw the fox soup that it trained

  --quick        everything small: whether it works, not a measurement
  --processor-time
                 frames, leave_out, growth and tradeoff by the processor time of all threads instead of the time
                 that passed: ratios on a busy machine, without a GPU (leave_out does so by itself there)
  --ficus SOUP   a soup of 2D Triangle Splatting; ../shared/data/soups/ficus_2dts.off where it is there
  --fox SOUP     a soup trained from photographs (docs/benchmarks.md, Photographs)
  --photographs  what it was trained from; ../shared/data/photos/fox where it is there
  --lego, --bottle DATASET
                 what else training learns from; ../shared/data/rendered/lego and ../shared/data/photos/bottle
                 where they are there

Ctrl-C ends it; parts that were done stay. Exit code 1 where a part failed.
END
}

say() { printf '==> %s\n' "$*" >&2; }
die() {
  printf 'dev bench: %s\n' "$*" >&2
  exit 2
}
skip() {
  skipped+=("$1")
  say "Skipped: $1"
}

# Programs of ours end themselves on Ctrl-C, and would leave the next one to begin.
trap 'exit 130' INT

while (($#)); do
  case $1 in
    --quick) quick=1 ;;
    --processor-time) processor=1 ;;
    --check) check=1 ;; # of the arguments alone
    --ficus | --fox | --photographs | --lego | --bottle)
      (($# > 1)) || die "$1 wants a path"
      declare "${1#--}=$2"
      shift
      ;;
    -h | --help) usage && exit ;;
    -*) die "there is no option $1; --help lists them" ;;
    *)
      [[ " ${all_parts[*]} " == *" $1 "* ]] || die "there is no part '$1'; there are ${all_parts[*]}"
      parts+=("$1")
      ;;
  esac
  shift
done
((${#parts[@]})) || parts=("${usual_parts[@]}")
for given in "$ficus" "$fox" "$photographs" "$lego" "$bottle"; do
  [[ -z $given || -e $given ]] || die "there is no $given"
done
[[ -n $ficus || ! -e $data/soups/ficus_2dts.off ]] || ficus=$data/soups/ficus_2dts.off
[[ -n $photographs || ! -e $data/photos/fox ]] || photographs=$data/photos/fox
[[ -n $lego || ! -e $data/rendered/lego ]] || lego=$data/rendered/lego
[[ -n $bottle || ! -e $data/photos/bottle ]] || bottle=$data/photos/bottle

[[ -z $check ]] || exit 0

# measure NAME COMMAND..: its output goes to NAME.txt, and its end is shown where it fails.
measure() {
  local name=$1 status=0
  shift
  say "$name: $*"
  "$@" >"$out/$name.txt" 2>"$out/$name.log" </dev/null || status=$?
  if ((status)); then
    tail -n 15 "$out/$name.log" >&2
    failed+=("$name (all it said: $out/$name.log)")
  else
    done_parts+=("$name")
  fi
  return "$status"
}

# Scenes, a name and a path each; a cut-out cloud keeps its own cameras.
scene_names=() scene_paths=()
add_scene() {
  scene_names+=("$1")
  scene_paths+=("$2")
}
find_scenes() {
  add_scene example examples/soup.glb
  local coverage
  for coverage in forty_percent all; do
    local cloud=$out/scenes/cloud_$coverage.glb
    [[ -e $cloud ]] || "$bin/make_cutout_cloud" "$cloud" --coverage "$coverage" ||
      { skip "the cut-out cloud $coverage, which could not be written"; continue; }
    add_scene "cloud-$coverage" "$cloud"
  done
  if [[ -n $ficus ]]; then add_scene ficus "$ficus"; else skip "the ficus soup: give it with --ficus"; fi
  if [[ -n $fox ]]; then add_scene fox "$fox"; else skip "the fox soup: train it (docs/benchmarks.md) and give it with --fox"; fi
}

part_load() {
  local base=${ficus:-examples/soup.glb} options=(--formats '.glb,.off,.ply')
  [[ -n $ficus ]] || say "load: made of the example, as there is no ficus"
  [[ -z $quick ]] || options+=(--triangles 50000 --repeats 1)
  measure load "$bin/load_benchmark" "$base" "$out/load" "${options[@]}"
}

part_frames() {
  "$bin/tureen" bench --help >/dev/null 2>&1 || { skip "frames: this program has no tureen bench"; return; }
  local i name path options
  for i in "${!scene_names[@]}"; do
    name=${scene_names[i]} path=${scene_paths[i]}
    case $name in
      cloud-*) options=(--cameras "$path" --size 1280x720) ;;
      *) options=(--cameras 'hemisphere:8,adversarial' --sweep) ;;
    esac
    options+=(--rounds 5 --seconds 120)
    [[ -z $quick ]] || options=(--size 160x90 --rounds 1 --seconds 1)
    [[ -z $processor ]] || options+=(--processor-time)
    measure "frames-$name" "$bin/tureen" bench "$path" "${options[@]}" -o "$out/frames-$name"
    [[ $name == fox && -n $photographs ]] || continue
    options=(--sizes 'full,half,quarter' --rounds 5 --seconds 120)
    [[ -z $quick ]] || options=(--sizes quarter --rounds 1 --seconds 1)
    [[ -z $processor ]] || options+=(--processor-time)
    measure "frames-fox-photographs" "$bin/tureen" bench "$path" "$photographs" "${options[@]}" \
      -o "$out/frames-fox-photographs"
  done
  measure_stages
  options=()
  [[ -z $quick ]] || options=(--triangles 50000 --rounds 1 --width 160 --height 90)
  [[ -z $processor ]] || options+=(--processor-time)
  measure frames-dense "$bin/dense_benchmark" "${ficus:-examples/soup.glb}" "${options[@]}"
}

# The shading pass as a fragment and as a compute shader.
measure_stages() {
  local i options
  if ! "$bin/tureen" render examples/soup.glb --shading compute --size 16x16 -o "$out/scenes/compute.png" \
    >/dev/null 2>&1; then
    skip "shading as compute, which this device cannot do"
    return
  fi
  for i in "${!scene_names[@]}"; do
    [[ ${scene_names[i]} != ficus ]] || continue # shaded forward
    options=(--cameras hemisphere:4 --rounds 2 --seconds 30)
    [[ ${scene_names[i]} != cloud-* ]] || options[1]=${scene_paths[i]}
    [[ -z $quick ]] || options=(--size 160x90 --rounds 1 --seconds 1)
    options+=(--only "tureen-fragment,tureen-compute")
    [[ -z $processor ]] || options+=(--processor-time)
    measure "stages-${scene_names[i]}" "$bin/tureen" bench "${scene_paths[i]}" "${options[@]}" \
      -o "$out/stages-${scene_names[i]}"
  done
}

part_leave_out() {
  local path scenes=() options=(--rounds 5)
  for path in "${scene_paths[@]}"; do
    [[ $path == */cloud_* ]] || scenes+=("$path") # clouds are among its own
  done
  [[ -z $quick ]] || options=(--rounds 1 --width 160 --height 90)
  measure leave_out "$bin/leave_out_benchmark" "${scenes[@]}" "${options[@]}"
  [[ ! -e $training/lego.glb ]] || scenes+=("$training/lego.glb")
  measure leave_out_counts "$bin/leave_out_audit" "${scenes[@]}"
}

part_growth() {
  measure growth "$bin/growth_benchmark" -o "$out/growth" ${quick:+--quick} \
    ${processor:+--processor-time}
}

part_tradeoff() {
  "$bin/tureen" tradeoff --help >/dev/null 2>&1 || { skip "tradeoff: this program has no tureen tradeoff"; return; }
  local i name options imports=()
  for i in "${!scene_names[@]}"; do
    name=${scene_names[i]} options=()
    [[ $name != cloud-* ]] || continue # a random network: its errors say nothing about scenes
    [[ $name != fox || -z $photographs ]] || options=("$photographs" --scale 0.25)
    measure "tradeoff-$name" "$bin/tureen" tradeoff "${scene_paths[i]}" "${options[@]}" \
      ${quick:+--quick} ${processor:+--processor-time} -o "$out/tradeoff-$name" || continue
    imports+=(--import "$out/tradeoff-$name/tradeoff.json")
  done
  if ((${#imports[@]} < 4)); then
    skip "tradeoff over several scenes: fewer than two were measured"
    return
  fi
  measure tradeoff-scenes "$bin/tureen" tradeoff "${imports[@]}" -o "$out/tradeoff-scenes"
}

# slim NAME SOUP OPTION..: a slim file of it. As quick as ever: it takes half a minute.
slim() {
  local name=$1 soup=$2
  shift 2
  measure "slim-$name" "$bin/tureen" convert "$soup" "$out/slim/$name.glb" --slim --force "$@"
}

part_slim() {
  mkdir -p "$out/slim"
  local lego_soup=$training/lego.glb
  slim example examples/soup.glb
  make_example_photographs && slim example-photographs examples/soup.glb --photographs "$example_photographs"
  if [[ -n $fox && -n $photographs ]]; then
    slim fox-photographs "$fox" --photographs "$photographs" --scale 0.25
  else
    skip "slim: the fox soup, or its photographs"
  fi
  if [[ ! -e $lego_soup ]]; then
    skip "slim: the lego soup, which the part training leaves"
    return
  fi
  slim lego "$lego_soup"
  [[ -z $lego ]] || slim lego-photographs "$lego_soup" --photographs "$lego" --scale 0.5
}

# Properties that tests recorded, from GoogleTest's XML: a table's row for each.
properties() {
  printf '| test | property | value |\n|---|---|---|\n'
  awk -F'"' '/<testcase / { test = $2 } /<property / { print "| " test " | " $2 " | " $4 " |" }' "$1"
}

part_agreement() {
  local program filter
  for program in agreement_tests gl_oracle_tests; do
    filter='*'
    [[ -z $quick || $program == agreement_tests ]] || filter='GlOracleSingle.*'
    measure "agreement-$program" "$bin/$program" --gtest_filter="$filter" \
      --gtest_output="xml:$out/$program.xml"
    [[ ! -e $out/$program.xml ]] || properties "$out/$program.xml" >"$out/agreement-$program.md"
  done
  [[ -e $data ]] || skip "agreement on real soups, which lie in ../shared/data"
}

part_step() {
  local size=(400 400 12)
  [[ -z $quick ]] || size=(64 64 1)
  measure step "$bin/training_benchmark" "${size[@]}"
}

part_browser() {
  [[ -e build/web/out/site/bench.html && -e web/node_modules/playwright-core ]] ||
    { skip "browser: the page is not built; ./dev web builds it"; return; }
  command -v "${CHROMIUM:-chromium}" >/dev/null || { skip "browser: there is no chromium"; return; }
  # The cloud covers a third of the picture, like the soup that the authors' page was timed with.
  local cloud=$out/scenes/cloud_third.glb imports=() file
  "$bin/make_cutout_cloud" "$cloud" --coverage third || { skip "browser: its scene could not be written"; return; }
  measure browser node tests/bench/browser_benchmark.mjs "$out/browser" "$cloud" examples/soup.glb ${quick:+--quick}
  for file in "$out"/browser/*.json; do imports+=(--import "$file"); done
  measure browser-tables "$bin/tureen" bench "${imports[@]}" -o "$out/browser/tables"
}

# Of what the example was trained on, from another renderer; once a commit.
make_example_photographs() {
  local views=(--views 90 --test-views 10 --strata 4)
  [[ -z $quick ]] || views=(--views 9 --test-views 1 --strata 1)
  local made_by=$example_photographs.commit commit
  commit=$(git describe --always --dirty 2>/dev/null || echo unknown)
  [[ -e $made_by && $(<"$made_by") == "$commit" ]] && return
  rm -rf "$example_photographs" "$made_by"
  measure example-photographs "$bin/make_photographs" "$example_photographs" "${views[@]}" &&
    echo "$commit" >"$made_by"
}

# steps N: so many, or few.
steps() { if [[ $quick ]]; then echo 20; else echo "$1"; fi; }

# train NAME DATASET OPTION..: a soup, its log and the log's plot. Fails where there is none.
train() {
  local name=$1 dataset=$2 soup=$training/$1.glb
  shift 2
  [[ -n $dataset ]] || { skip "training on the $name: its photographs are not here"; return 1; }
  rm -f "${soup%.glb}.checkpoint" # of a run that was broken off
  measure "train-$name" "$bin/tureen" train "$dataset" "$@" -o "$soup" --json
}

# evaluate NAME DATASET OPTION..: what photographs say of a soup that was trained.
evaluate() {
  local name=$1
  shift
  measure "train-$name-eval" "$bin/tureen" eval "$training/$name.glb" "$@"
}

# One constant changed at a time: a name, and what changes it.
train_ablations() {
  [[ -n $lego ]] || { skip "the ablations, which train on lego"; return; }
  local small=(--scale 0.125 --triangles 2000 --steps "$(steps 2500)") name constants
  train ablation-ours "$lego" "${small[@]}"
  train ablation-another-seed "$lego" "${small[@]}" --seed 1
  train ablation-compat-level-3 "$lego" "${small[@]}" --compat --level 3
  train ablation-compat "$lego" "${small[@]}" --compat
  while read -r name constants; do
    echo "$constants" >"$training/$name.json"
    train "ablation-$name" "$lego" "${small[@]}" --config "$training/$name.json"
  done <<'END'
no-baseline {"baseline": false}
copied-texels {"resample_textures": false}
half-gradients {"gradient_precision": "float16"}
longest-edges {"split_by_error": false, "turnover": 0}
slow-vertices {"vertex_rate": 1e-3}
END
}

part_training() {
  mkdir -p "$training"
  if train fox "$photographs" --scale 0.25 --steps "$(steps 10000)"; then
    evaluate fox "$photographs" --scale 0.25
    [[ -n $fox ]] || fox=$training/fox.glb
  fi
  train bottle "$bottle" --scale 0.5 --steps "$(steps 1500)"
  train lego "$lego" --scale 0.5 --steps "$(steps 10000)" && evaluate lego "$lego" --scale 0.5
  make_example_photographs &&
    train example "$example_photographs" --config examples/training.json --steps "$(steps 3000)" &&
    evaluate example "$example_photographs"
  train_ablations
}

mkdir -p "$out/scenes"
example_photographs=$out/photographs${quick:+-quick} training=$out/training${quick:+-quick}
[[ " ${parts[*]} " != *" training "* ]] || part_training
case " ${parts[*]} " in
  *" frames "* | *" leave_out "* | *" tradeoff "*) find_scenes ;;
esac
for part in "${parts[@]}"; do [[ $part == training ]] || "part_$part"; done

{
  echo "# Measured $(date -u +%Y-%m-%dT%H:%MZ)${quick:+, --quick: whether it works, not a measurement}${processor:+, by processor time}"
  echo
  echo "Commit $(git describe --always --dirty 2>/dev/null || echo unknown), $(nproc) cores."
  for name in "${done_parts[@]}"; do echo "- $name: $name.txt, $name.log"; done
  for name in "${skipped[@]}"; do echo "- skipped: $name"; done
  for name in "${failed[@]}"; do echo "- FAILED: $name"; done
  for page in "$out"/*/*.html; do [[ ! -e $page ]] || echo "- page: ${page#"$out"/}"; done
} >"$out/summary.md"
cat "$out/summary.md" >&2
say "All of it is in $PWD/$out"
((${#failed[@]} == 0))
