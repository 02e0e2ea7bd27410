#!/usr/bin/env bash
# An installation from a build folder, and the Debian package: tree.sh BUILD_FOLDER CMAKE CPACK. The
# installed program runs where nothing of the sources can be found.
set -euo pipefail
build=$1 cmake=$2 cpack=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
die() { echo "tree.sh: $*" >&2; exit 1; }

DESTDIR=$scratch/stage "$cmake" --install "$build" --prefix /usr >"$scratch/log" || { cat "$scratch/log"; exit 1; }
mv "$scratch/stage/usr" "$scratch/moved"
share=$scratch/moved/share
for file in man/man1/palpate.1.gz man/man1/palpate-emulator.1.gz man/man5/palpate-scenario.5.gz \
  bash-completion/completions/palpate zsh/vendor-completions/_palpate fish/vendor_completions.d/palpate.fish \
  palpate/palpate.schema.json palpate/scenarios/quickstart.toml palpate/materials/chen2007.toml doc/palpate/copyright; do
  [[ -s $share/$file ]] || die "share/$file is not installed"
done
for page in "$share"/man/man*/*.gz; do
  gzip -cd "$page" >"$scratch/page"
  mandoc -T lint -W warning "$scratch/page" | grep -v -e 'missing date' -e 'skipping paragraph macro' | grep . && die "$page is not a good man page"
done
gzip -cd "$share/man/man1/palpate.1.gz" | mandoc -T utf8 | sed 's/.\x08//g' | grep -e '--dry-run' >/dev/null || die "palpate.1 lacks --dry-run"
gzip -cd "$share/man/man5/palpate-scenario.5.gz" | mandoc -T utf8 | sed 's/.\x08//g' | grep young_modulus >/dev/null || die "palpate-scenario.5 lacks a key"

mkdir "$scratch/home"
cd "$scratch/home"
env -i PATH="$scratch/moved/bin:/usr/bin:/bin" HOME="$scratch/home" bash -ec '
  palpate run quickstart --quiet
  palpate explain quickstart >explained
  palpate new press; palpate run press.toml --dry-run' >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
[[ -s out/quickstart/force_indentation.csv ]] || die "the quickstart wrote no curve"
[[ ! -e out/press ]] || die "--dry-run wrote something"

"$cpack" --config "$build/CPackConfig.cmake" -B "$scratch/package" >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
deb=$(echo "$scratch"/package/*.deb)
dpkg-deb --info "$deb" >"$scratch/info"
dpkg-deb --contents "$deb" >"$scratch/contents"
for line in '^ Package: palpate$' '^ Section: science$' '^ Depends: .*libc6' '^ Depends: .*libtet' '^ Recommends: gnuplot'; do
  grep -q "$line" "$scratch/info" || die "the package lacks \`$line\`: $(cat "$scratch/info")"
done
for file in usr/bin/palpate usr/bin/palpate-emulator usr/share/man/man1/palpate.1.gz usr/share/doc/palpate/copyright; do
  grep -q " ./$file$" "$scratch/contents" || die "the package has no $file"
done
if grep -v ' \./$\| \./usr/' "$scratch/contents"; then die "the package has files outside /usr"; fi
dpkg-deb --fsys-tarfile "$deb" | tar -xO ./usr/share/doc/palpate/copyright | grep 'AFFERO GENERAL PUBLIC' >/dev/null || die "no licence"
echo "installed, moved and packaged"
