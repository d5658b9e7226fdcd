#!/usr/bin/env bash
# Measures what docs/benchmarks.md, leaving-out.md and slim.md hold, and writes it there. `./dev bench`
# builds what this needs and calls it, from the repository's root.
set -uo pipefail

bin=build/release/bin data=../shared/data
usual_parts=(load frames gpu leave_out growth tradeoff slim agreement step browser)
training_parts=(train-fox train-bottle train-lego train-example ablations)
all_parts=("${usual_parts[@]}" training "${training_parts[@]}")
quick='' processor='' check='' ficus='' fox='' photographs='' lego='' bottle=''
parts=() done_parts=() reported=() skipped=() failed=()

usage() {
  cat <<'END'
usage: ./dev bench [--quick] [--processor-time] [--ficus SOUP] [--fox SOUP]
                   [--photographs DATASET] [--lego DATASET] [--bottle DATASET] [PART..]

Measures, leaves tables, plots and pages in build/bench, and writes what pages of docs/ hold of them between
their marks; without a PART all but training:
  load        how long a soup of 2,000,000 triangles takes to load from each format, and its memory
  frames      tureen bench: frame times across sizes, on every scene there is
  gpu         frames from 1280x720 to 3840x2160, 2,000,000 triangles among them, against what the device can do at
              most, the published pipeline and the shading stages; left out where OpenGL is software
  leave_out   what each thing that a plan leaves out gains
  growth      the time of a frame against triangles, pixels and overdraw, and its model
  tradeoff    tureen tradeoff: error against run time, on every scene there is and over all of them
  slim        what tureen convert --slim makes of every soup there is
  agreement   how well GL agrees with the oracle
  step        what a training step costs
  browser     bench.html in Chromium on two rasterisers, memory, and how long the first picture takes
  training    the training runs: hours; the others draw the soups that it left in build/bench/training. Each is
              a part by itself, too, and then stands in the table beside those that were made before:
              train-fox, train-bottle, train-lego, train-example, ablations

  --quick        everything small, in build/bench-quick, with copies of the pages there: whether it works, not a
                 measurement
  --processor-time
                 frames, leave_out, growth and tradeoff by the processor time of all threads instead of the time
                 that passed: ratios on a busy machine, without a GPU (leave_out does so by itself there)
  --ficus SOUP   a soup of 2D Triangle Splatting; ../shared/data/soups/ficus_2dts.off where it is there
  --fox SOUP     a soup trained from photographs; what the part train-fox left
  --photographs  what it was trained from; ../shared/data/photos/fox where it is there
  --lego, --bottle DATASET
                 what else training learns from; ../shared/data/rendered/lego and ../shared/data/photos/bottle
                 where they are there

Ctrl-C ends it; what was done stays in build/bench, and comes into no page. Exit code 1 where a part failed.
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
out=build/bench${quick:+-quick}
training=$out/training example_photographs=$out/photographs
for given in "$ficus" "$fox" "$photographs" "$lego" "$bottle"; do
  [[ -z $given || -e $given ]] || die "there is no $given"
done
[[ -n $ficus || ! -e $data/soups/ficus_2dts.off ]] || ficus=$data/soups/ficus_2dts.off
[[ -n $photographs || ! -e $data/photos/fox ]] || photographs=$data/photos/fox
[[ -n $lego || ! -e $data/rendered/lego ]] || lego=$data/rendered/lego
[[ -n $bottle || ! -e $data/photos/bottle ]] || bottle=$data/photos/bottle

[[ -z $check ]] || exit 0

# What an earlier run wrote into the pages makes no other program.
commit=$(git describe --always 2>/dev/null || echo unknown)
[[ $commit == unknown ]] || git diff --quiet HEAD -- . ':!docs' || commit+=-dirty
cpu=$(awk -F ': ' '/^model name/ { print $2; exit }' /proc/cpuinfo 2>/dev/null)

json_text() { printf '"%s"' "$(sed 's/[\\"]/\\&/g' <<<"$1")"; }

# measure NAME COMMAND..: its output goes to NAME.txt, and its end is shown where it fails. NAME.run.json, by which
# bench_report knows it, says when, where and how it was done.
measure() {
  local name=$1 status=0 command
  shift
  command=$(printf '%q ' "$@") # as a shell takes it
  command=${command% }
  say "$name: $command"
  rm -f "$out/$name.run.json" "$out/$name"/*.svg # plots of an earlier run are not this one's
  "$@" >"$out/$name.txt" 2>"$out/$name.log" </dev/null || status=$?
  if ((status)); then
    tail -n 15 "$out/$name.log" >&2
    failed+=("$name (all it said: $out/$name.log)")
  else
    done_parts+=("$name")
    printf '{"command": %s, "date": "%s", "commit": %s, "cpu": %s, "cores": %d}\n' "$(json_text "$command")" \
      "$(date -u +%Y-%m-%dT%H:%M:%SZ)" "$(json_text "$commit")" "$(json_text "${cpu:-unknown}")" "$(nproc)" \
      >"$out/$name.run.json"
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
    "$bin/make_cutout_cloud" "$cloud" --coverage "$coverage" ||
      { skip "the cut-out cloud $coverage, which could not be written"; continue; }
    add_scene "cloud-$coverage" "$cloud"
  done
  if [[ -n $ficus ]]; then add_scene ficus "$ficus"; else skip "the ficus soup: give it with --ficus"; fi
  if [[ -n $fox ]]; then add_scene fox "$fox"; else skip "the fox soup: train it (docs/benchmarks.md) and give it with --fox"; fi
}

part_load() {
  local base=${ficus:-examples/soup.glb} options=(--formats '.glb,.off,.ply')
  # Made of the example it would be another soup than the page says.
  [[ -n $ficus || -n $quick ]] || { skip "load: the ficus soup is not here, give it with --ficus"; return; }
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
    options+=(--rounds 5 --seconds 300)
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
  [[ -n $ficus || -n $quick ]] || { skip "frames-dense: the ficus soup is not here, give it with --ficus"; return; }
  local dense=("$bin/dense_benchmark" "${ficus:-examples/soup.glb}")
  [[ -z $quick ]] || dense+=(--triangles 50000 --rounds 1 --width 160 --height 90)
  [[ $processor ]] || measure frames-dense "${dense[@]}"
  if draws_in_software; then
    measure frames-dense-processor "${dense[@]}" --processor-time
  else
    skip "frames-dense-processor: the processor's time says nothing of this device"
  fi
}

# Whether the processor's time says anything of frames.
draws_in_software() {
  "$bin/tureen" render examples/soup.glb --size 16x16 -o "$out/scenes/device.png" --json 2>/dev/null |
    grep -q '"software": true'
}

shades_as_compute() {
  "$bin/tureen" render examples/soup.glb --shading compute --size 16x16 -o "$out/scenes/compute.png" >/dev/null 2>&1
}

# The shading pass as a fragment and as a compute shader.
measure_stages() {
  local i options
  if ! shades_as_compute; then
    skip "shading as compute, which this device cannot do"
    return
  fi
  for i in "${!scene_names[@]}"; do
    [[ ${scene_names[i]} != ficus ]] || continue # shaded forward
    options=(--cameras hemisphere:4 --rounds 5 --seconds 60)
    [[ ${scene_names[i]} != cloud-* ]] || options[1]=${scene_paths[i]}
    [[ -z $quick ]] || options=(--size 160x90 --rounds 1 --seconds 1)
    options+=(--only "tureen-fragment,tureen-compute")
    [[ -z $processor ]] || options+=(--processor-time)
    measure "stages-${scene_names[i]}" "$bin/tureen" bench "${scene_paths[i]}" "${options[@]}" \
      -o "$out/stages-${scene_names[i]}"
  done
}

# Against the device's ceilings: what it takes for triangles without colours, and for a copy of the pixels.
part_gpu() {
  [[ -n $quick ]] || ! draws_in_software || { skip "gpu: OpenGL is drawn by the processor here"; return; }
  local i only stages=tureen-fragment sizes options dense=$out/scenes/dense.glb names=("${scene_names[@]}") paths=("${scene_paths[@]}")
  if [[ -n $ficus || -n $quick ]]; then
    if "$bin/make_dense_soup" "${ficus:-examples/soup.glb}" "$dense" ${quick:+--triangles 50000}; then
      names+=(dense) paths+=("$dense")
    else
      skip "gpu-dense, whose scene could not be written"
    fi
  else
    skip "gpu-dense: the ficus soup is not here, give it with --ficus"
  fi
  ! shades_as_compute || stages+=,tureen-compute
  for i in "${!names[@]}"; do
    only=tureen,published,triangles,copy,$stages sizes=1280x720,1920x1080,3840x2160
    case ${names[i]} in
      ficus | dense) only=tureen,triangles,copy options=(--cameras orbit:8) ;; # opaque: forward, with no network
      cloud-*)
        options=(--cameras "${paths[i]}")
        sizes+=,1237x822,2473x1643,4946x3286 # outdoor photographs of Mip-NeRF 360: a quarter, half, full
        ;;
      *) options=(--cameras hemisphere:8) ;;
    esac
    if [[ $quick ]]; then
      options+=(--size 160x90 --rounds 1 --seconds 1)
    else
      options+=(--size "$sizes" --rounds 5 --seconds 60)
    fi
    measure "gpu-${names[i]}" "$bin/tureen" bench "${paths[i]}" "${options[@]}" --only "$only" -o "$out/gpu-${names[i]}"
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

# slim NAME SOUP OPTION..: a slim file of it. As quick as ever: it takes half a minute or less.
slim() {
  local name=$1 soup=$2
  shift 2
  measure "slim-$name" "$bin/tureen" convert "$soup" "$out/slim/$name.glb" --slim --force --json "$@"
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
  awk -F'"' '
    /<testsuite / { suite = $2 }
    /<testcase / { test = suite "." $2 }
    /<property / { print "| " test " | " $2 " | " $4 " |" }' "$1"
}

# Of tests that record how well pictures agree, hundreds of them: the worst of each test, over all its parameters
# but those of real scenes, which are told apart.
worst_agreement() {
  printf '| test | pictures | coverage mismatch, at most | face mismatch, at most | dB, at least |\n|---|---|---|---|---|\n'
  awk -F'"' '
    /<testsuite / { suite = $2 }
    /<testcase / { name = $2; if (suite !~ /RealData/) sub(/\/.*/, "", name); test = suite "." name }
    /<property / && match($4, /^coverage mismatch /) {
      split($4, part, ", ")
      split(part[1], coverage, " "); split(part[2], face, " "); split(part[3], psnr, " ")
      if (!(test in count)) { order[++tests] = test; least[test] = psnr[1] }
      ++count[test]
      if (coverage[3] + 0 > most[test] + 0) most[test] = coverage[3]
      if (face[3] + 0 > faces[test] + 0) faces[test] = face[3]
      if (psnr[1] + 0 < least[test] + 0) least[test] = psnr[1]
    }
    END {
      for (i = 1; i <= tests; ++i) {
        test = order[i]
        printf "| %s | %d | %.2g | %.2g | %.1f |\n", test, count[test], most[test], faces[test], least[test]
      }
    }' "$1"
}

# tested NAME TABLE PROGRAM FILTER: what these tests record, as the table that the function TABLE makes of it.
tested() {
  mkdir -p "$out/$1"
  measure "$1" "$bin/$3" --gtest_filter="$4" --gtest_output="xml:$out/$1/tests.xml" &&
    "$2" "$out/$1/tests.xml" >"$out/$1/table.md"
}

part_agreement() {
  local filter='-*PublishedError*' # which stands by itself
  [[ -z $quick ]] || filter='GlOracleSingle.*'
  if [[ -e $data ]]; then tested agreement-real worst_agreement agreement_tests '*'; else skip "agreement on real soups, which lie in $data"; fi
  tested agreement-random worst_agreement gl_oracle_tests "$filter"
  tested error properties gl_oracle_tests '*PublishedError*'
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
  rm -f "$out"/browser/*.json # of an earlier run
  measure browser node tests/bench/browser_benchmark.mjs "$out/browser" "$cloud" examples/soup.glb ${quick:+--quick} || return
  for file in "$out"/browser/*.json; do imports+=(--import "$file"); done
  measure browser-devices "$bin/tureen" bench "${imports[@]}" -o "$out/browser-devices" &&
    cp "$out/browser-devices/devices.md" "$out/browser-devices/table.md"
}

# Of what the example was trained on, from another renderer; once a commit.
make_example_photographs() {
  local views=(--views 90 --test-views 10 --strata 4)
  [[ -z $quick ]] || views=(--views 9 --test-views 1 --strata 1)
  local made_by=$example_photographs.commit
  [[ $commit != *-dirty && -e $example_photographs && -e $made_by && $(<"$made_by") == "$commit" ]] && return
  rm -rf "$example_photographs" "$made_by"
  measure example-photographs "$bin/make_photographs" "$example_photographs" "${views[@]}" &&
    echo "$commit" >"$made_by"
}

# steps N: so many, or few.
steps() { if [[ $quick ]]; then echo 20; else echo "$1"; fi; }

# train NAME DATASET OPTION..: a soup, its log and the log's plot. Fails where there is none.
train() {
  local name=$1 dataset=$2 soup=$training/${1#train-}.glb
  shift 2
  [[ -n $dataset ]] || { skip "$name: its photographs are not here"; return 1; }
  rm -f "${soup%.glb}.checkpoint" # of a run that was broken off
  measure "$name" "$bin/tureen" train "$dataset" "$@" -o "$soup" --json || return 1
  mkdir -p "$out/$name"
  cp "${soup%.glb}.svg" "$out/$name/log.svg" || say "$name: there is no plot of its log"
}

# One constant changed at a time: a name, and what changes it.
part_ablations() {
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

part_train-fox() { train train-fox "$photographs" --scale 0.25 --steps "$(steps 10000)"; }
part_train-bottle() { train train-bottle "$bottle" --scale 0.5 --steps "$(steps 1500)"; }
part_train-lego() { train train-lego "$lego" --scale 0.5 --steps "$(steps 10000)"; }
part_train-example() {
  make_example_photographs &&
    train train-example "$example_photographs" --config examples/training.json --steps "$(steps 3000)"
}

# Runs of training that this folder holds and this call did not make.
trained_before() {
  local file name
  for file in "$out"/{train,ablation}-*.run.json; do
    name=$(basename "$file" .run.json)
    [[ ! -e $file || " ${done_parts[*]} " == *" $name "* ]] || echo "$name"
  done
}

mkdir -p "$out/scenes" "$training"
for part in "${training_parts[@]}"; do
  [[ " ${parts[*]} " != *" training "* && " ${parts[*]} " != *" $part "* ]] || "part_$part"
done
[[ -n $fox || ! -e $training/fox.glb ]] || fox=$training/fox.glb
case " ${parts[*]} " in
  *" frames "* | *" gpu "* | *" leave_out "* | *" tradeoff "*) find_scenes ;;
esac
for part in "${parts[@]}"; do
  [[ " training ${training_parts[*]} " == *" $part "* ]] || "part_$part"
done

# What is only tried leaves the pages as they are.
pages=docs
if [[ $quick ]]; then
  pages=$out/docs
  rm -rf "$pages"
  cp -r docs "$pages"
fi
if ((${#done_parts[@]})); then
  for name in "${done_parts[@]}"; do
    [[ $name == example-photographs ]] || reported+=("$name") # of which nothing is told
  done
  [[ " ${done_parts[*]}" != *" "@(train|ablation)-* ]] || mapfile -t -O "${#reported[@]}" reported < <(trained_before)
fi
if ((${#reported[@]})); then
  "$bin/bench_report" "$out" "$pages" "${reported[@]}" || failed+=("bench_report: $pages is not whole")
fi

{
  echo "# Measured $(date -u +%Y-%m-%dT%H:%MZ)${quick:+, --quick: whether it works, not a measurement}${processor:+, by processor time}"
  echo
  echo "Commit $commit, $(nproc) cores."
  for name in "${done_parts[@]}"; do echo "- $name: $name.txt, $name.log"; done
  for name in "${skipped[@]}"; do echo "- skipped: $name"; done
  for name in "${failed[@]}"; do echo "- FAILED: $name"; done
  for name in "${done_parts[@]}"; do
    for page in "$out/$name"/*.html; do [[ ! -e $page ]] || echo "- page: ${page#"$out"/}"; done
  done
} >"$out/summary.md"
cat "$out/summary.md" >&2
say "All of it is in $PWD/$out, the pages in $pages"
((${#failed[@]} == 0))
