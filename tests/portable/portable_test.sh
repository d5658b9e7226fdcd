#!/usr/bin/env bash
# Packs the portable folder, unpacks it elsewhere and runs it twice: on this system, which has EGL or
# OSMesa, and in a root folder that contains only glibc.
#
# use: portable_test.sh CMAKE SOURCE_FOLDER BUILD_FOLDER WERROR
set -euo pipefail
cmake=$1 source=$2 build=$3-portable werror=$4

fail() {
  printf 'FAILED: %s\n' "$@" >&2
  exit 1
}

# With the ordinary build's flags, so that ccache has all objects already.
export CCACHE_BASEDIR=$source
cd "$source"
"$cmake" --preset portable -B "$build" -DTUREEN_WERROR="$werror" >/dev/null
"$cmake" --build "$build" --target package

packages=("$build"/tureen-*.tar.gz)
((${#packages[@]} == 1)) || fail "one package expected: ${packages[*]}"
work=$build/"moved elsewhere" # a space on purpose
rm -rf "$work"
mkdir -p "$work"
tar -xzf "${packages[0]}" -C "$work"
name=$(basename "${packages[0]}" .tar.gz)
folder=$work/$name
for file in tureen LICENSE README.md examples; do
  [[ -e $folder/$file ]] || fail "$name lacks $file"
done

# Needed libraries are beside the program or part of glibc, at most in Debian 12's version (README).
promised=2.36
grep -qwF "$promised" README.md || fail "the README does not name glibc $promised"
for file in "$folder"/tureen "$folder"/*.so*; do
  [[ -e $file ]] || continue
  while read -r needed; do
    [[ -e $folder/$needed || $needed =~ ^(lib(c|m|dl|rt|pthread|resolv)\.so\.|ld-linux) ]] ||
      fail "$(basename "$file") needs $needed, which is not beside it"
  done < <(objdump -p "$file" | awk '$1 == "NEEDED" { print $2 }')
  glibc=$(objdump -T "$file" | sed -n 's/.*GLIBC_\([0-9.]*\).*/\1/p' | sort -Vu | tail -n 1)
  echo "$(basename "$file") needs glibc $glibc; the README names $promised"
  [[ $(printf '%s\n' "$glibc" "$promised" | sort -V | tail -n 1) == "$promised" ]] ||
    fail "$(basename "$file") needs a newer glibc than the README names"
done
[[ $(objdump -p "$folder/tureen" | awk '$1 ~ /^R(UN)?PATH$/ { print $2 }') == \$ORIGIN ]] ||
  fail "the program does not load libraries from its own folder only"

# 1. With a clean environment, from another folder.
scenes=("$folder"/examples/*.glb)
(cd / && env -i "$folder/tureen" render "${scenes[0]}" --size 64x48 -o "$work/picture.png") ||
  fail "render ended with $?"
[[ $(head -c 4 "$work/picture.png" | od -An -tx1 | tr -d ' \n') == 89504e47 ]] ||
  fail "render wrote no PNG"

# 2. Without a GL library: in a separate root.
root=$work/root
mkdir -p "$root"
cp -r "$folder" "$root/tureen"
libraries=$(ldd "$folder/tureen")
while read -r library; do
  mkdir -p "$root$(dirname "$library")"
  cp -L "$library" "$root$library"
done < <(grep -o '/[^ ]*/\(ld-linux\|lib\(c\|m\|dl\|rt\|pthread\|resolv\)\.so\)[^ ]*' <<<"$libraries")
PATH=$PATH:/usr/sbin:/sbin # contains chroot; not in every user's PATH
enter=("$(command -v chroot)")
((EUID == 0)) || enter=("$(command -v unshare)" --user --map-root-user "${enter[@]}")
# That root has no /proc, which the loader needs for $ORIGIN; step 1 has tested $ORIGIN.
enter=(env -i LD_LIBRARY_PATH=/tureen "${enter[@]}" "$root")
if ! "${enter[@]}" /tureen/tureen --help >/dev/null 2>"$work/enter.txt"; then
  cat "$work/enter.txt"
  grep -q '\(chroot\|unshare\): ' "$work/enter.txt" || fail "--help fails with only glibc"
  echo "SKIPPED: hiding GL needs root or user namespaces"
  exit 77
fi
status=0
"${enter[@]}" /tureen/tureen render "/tureen/examples/$(basename "${scenes[0]}")" \
  -o /picture.png 2>"$work/errors.txt" >&2 || status=$?
cat "$work/errors.txt"
((status == 4)) || fail "without GL, exit code 4 expected, got $status"
[[ $(<"$work/errors.txt") =~ libegl1.*libosmesa6 ]] ||
  fail "the message does not name libegl1 and libosmesa6"
[[ ! -e $root/picture.png ]] || fail "an image was written without GL"
echo "passed"
