#!/usr/bin/env bash
# The archive of `./dev archive`: archive.sh ARCHIVE.tar.gz, or archive.sh BUILD_FOLDER CPACK, which makes one. What it
# contains asks for nothing newer than glibc 2.34 and the C++ library of GCC 11, finds every library beside itself but
# those of C and C++, and runs where it was unpacked.
set -euo pipefail
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
die() { echo "archive.sh: $*" >&2; exit 1; }
if (($# == 2)); then
  "$2" -G TGZ --config "$1/CPackConfig.cmake" -B "$scratch/package" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
  set -- "$scratch"/package/*.tar.gz
fi

mkdir "$scratch/unpacked"
tar -xzf "$1" -C "$scratch/unpacked"
top=$(echo "$scratch"/unpacked/*)
[[ $(basename "$top").tar.gz == "$(basename "$1")" ]] || die "it unpacks as $(basename "$top")"

runtime='^(ld-linux-x86-64|libc|libm|libpthread|libdl|librt|libstdc\+\+|libgcc_s)\.so\.'
faults=0
fault() { echo "$*"; faults=$((faults + 1)); }
# newest NAME: the newest version of NAME that is allowed. CXXABI and GCC are those of GCC 11 as well.
newest() {
  case $1 in
    GLIBC) echo 2.34 ;;
    GLIBCXX) echo 3.4.29 ;;
    CXXABI) echo 1.3.13 ;;
    GCC) echo 7.0.0 ;;
    *) echo 999 ;;  # a library's own
  esac
}
for file in "$top"/bin/* "$top"/lib/palpate/*; do
  name=${file#"$top/"}
  objdump -p "$file" >"$scratch/headers"
  sed -n '/^Version References:/,/^$/s/.* \([A-Z]*_[A-Za-z0-9_.]*\)$/\1/p' "$scratch/headers" | sort -u >"$scratch/versions"
  while read -r version; do
    number=${version#*_}
    if [[ $version == GLIBC_* && ! $number =~ ^[0-9.]+$ ]] ||
      [[ $(printf '%s\n' "$number" "$(newest "${version%%_*}")" | sort -V | tail -n 1) != "$(newest "${version%%_*}")" ]]; then
      fault "$name asks for $version:" "$(objdump -T "$file" | grep -F "$version" | sed 's/.* //' | tr '\n' ' ')"
    fi
  done <"$scratch/versions"
  while read -r needed; do
    [[ $needed =~ $runtime || -s $top/lib/palpate/$needed ]] || fault "$name needs $needed, which is not in the archive"
  done < <(sed -n 's/^ *NEEDED *//p' "$scratch/headers")
  ldd "$file" >"$scratch/found" 2>&1 || fault "$name: $(cat "$scratch/found")"
  [[ $name == lib/* ]] || while read -r needed _ found _; do
    [[ $needed =~ $runtime || $found == "$top"/bin/../lib/palpate/* ]] || fault "$name takes $needed from $found"
  done < <(grep '=>' "$scratch/found")
  [[ $(wc -l <"$scratch/versions") != 0 ]] || fault "$name: no versions were read"
done
for file in share/man/man1/palpate.1.gz share/man/man5/palpate-scenario.5.gz share/bash-completion/completions/palpate \
  share/palpate/scenarios/quickstart.toml share/doc/palpate/copyright share/doc/palpate/libraries/sources; do
  [[ -s $top/$file ]] || fault "there is no $file"
done
((faults == 0)) || die "$faults faults"

mkdir "$scratch/home"
cd "$scratch/home"
env -i PATH="$top/bin:/usr/bin:/bin" HOME="$scratch/home" palpate run quickstart --quiet
[[ -s out/quickstart/force_indentation.csv ]] || die "the quickstart wrote no curve"
echo "$(basename "$1"): $(ls "$top"/lib/palpate | wc -l) libraries beside it, nothing newer than GLIBC_2.34 and GLIBCXX_3.4.29"
