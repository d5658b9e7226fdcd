#!/usr/bin/env bash
# Packs the portable folder, unpacks it elsewhere and runs it twice: where EGL or OSMesa can be
# found, and in a root folder that holds glibc and nothing else, so that neither can.
#
# use: portable_test.sh CMAKE SOURCE_FOLDER BUILD_FOLDER WERROR
set -euo pipefail
cmake=$1 source=$2 build=$3-portable werror=$4

fail() {
  printf 'FAILED: %s\n' "$@" >&2
  exit 1
}

# Beside the ordinary build folder and with its flags, so that ccache knows all objects already.
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

# What it needs lies beside it or is glibc's, and no newer glibc than Debian 12's, which the README names.
promised=2.36
grep -qwF "$promised" README.md || fail "the README does not name glibc $promised"
for file in "$folder"/tureen "$folder"/*.so*; do
  [[ -e $file ]] || continue
  while read -r needed; do
    [[ -e $folder/$needed || $needed =~ ^(lib(c|m|dl|rt|pthread|resolv)\.so\.|ld-linux) ]] ||
      fail "$(basename "$file") needs $needed, which does not lie beside it"
  done < <(objdump -p "$file" | awk '$1 == "NEEDED" { print $2 }')
  glibc=$(objdump -T "$file" | sed -n 's/.*GLIBC_\([0-9.]*\).*/\1/p' | sort -Vu | tail -n 1)
  echo "$(basename "$file") needs glibc $glibc; the README promises $promised"
  [[ $(printf '%s\n' "$glibc" "$promised" | sort -V | tail -n 1) == "$promised" ]] ||
    fail "$(basename "$file") needs a newer glibc than the README promises"
done
[[ $(objdump -p "$folder/tureen" | awk '$1 ~ /^R(UN)?PATH$/ { print $2 }') == \$ORIGIN ]] ||
  fail "the program looks for libraries elsewhere than beside itself"

# 1. With a clean environment, from another folder.
scenes=("$folder"/examples/*.glb)
(cd / && env -i "$folder/tureen" render "${scenes[0]}" --size 64x48 -o "$work/picture.png") ||
  fail "render ended with $?"
[[ $(head -c 4 "$work/picture.png" | od -An -tx1 | tr -d ' \n') == 89504e47 ]] ||
  fail "render wrote no PNG"

# 2. Where there is no GL library: a root of its own.
root=$work/root
mkdir -p "$root"
cp -r "$folder" "$root/tureen"
libraries=$(ldd "$folder/tureen")
while read -r library; do
  mkdir -p "$root$(dirname "$library")"
  cp -L "$library" "$root$library"
done < <(grep -o '/[^ ]*/\(ld-linux\|lib\(c\|m\|dl\|rt\|pthread\|resolv\)\.so\)[^ ]*' <<<"$libraries")
PATH=$PATH:/usr/sbin:/sbin # where chroot is, and a plain user does not look
enter=("$(command -v chroot)")
((EUID == 0)) || enter=("$(command -v unshare)" --user --map-root-user "${enter[@]}")
# There is no /proc in that root, from which the loader learns $ORIGIN; step 1 has proven it.
enter=(env -i LD_LIBRARY_PATH=/tureen "${enter[@]}" "$root")
if ! "${enter[@]}" /tureen/tureen --help >/dev/null 2>"$work/enter.txt"; then
  cat "$work/enter.txt"
  grep -q '\(chroot\|unshare\): ' "$work/enter.txt" || fail "--help fails where only glibc is"
  echo "SKIPPED: neither root nor user namespaces here, GL cannot be hidden"
  exit 77
fi
status=0
"${enter[@]}" /tureen/tureen render "/tureen/examples/$(basename "${scenes[0]}")" \
  -o /picture.png 2>"$work/errors.txt" >&2 || status=$?
cat "$work/errors.txt"
((status == 4)) || fail "exit code 4 expected where there is no GL, got $status"
[[ $(<"$work/errors.txt") =~ libegl1.*libosmesa6 ]] ||
  fail "the message does not say to install libegl1 or libosmesa6"
[[ ! -e $root/picture.png ]] || fail "a picture appeared without GL"
echo "passed"
