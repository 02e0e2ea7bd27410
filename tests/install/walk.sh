#!/usr/bin/env bash
# A newcomer's walk on a bare Debian 12: walk.sh PACKAGE.deb [ROOT]. As root. Installs the package into a
# fresh system in the folder ROOT, runs the quickstart as README.md writes it, tries the man pages and
# completion, removes the package and lists what it leaves behind: nothing.
set -euo pipefail
deb=$(readlink -f "$1")
top=$(dirname "$(readlink -f "$0")")/../..
root=${2:-$(mktemp -d)/debian}

step() { printf '%4d s  %s\n' "$SECONDS" "$*"; }
die() { echo "walk.sh: $*" >&2; exit 1; }
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
files() { find "$root" -xdev -not -path "$root/proc/*" -not -path "$root/var/*" -not -path "$root/srv/*" -printf '%P\n' | sort; }

trap 'umount "$root/proc" 2>/dev/null || true' EXIT
if [[ ! -d $root/usr ]]; then
  step "debootstrap --variant=minbase bookworm"
  mirror=$(sed -n 's/^deb \(\[[^]]*\] \)\?\(http[^ ]*\) bookworm .*/\2/p; s/^URIs: *//p' /etc/apt/sources.list \
    /etc/apt/sources.list.d/* 2>/dev/null | head -n 1) || true
  debootstrap --variant=minbase bookworm "$root" ${mirror:+"$mirror"} >"$root.log" 2>&1 || die "see $root.log"
fi
mount -t proc proc "$root/proc"
cp -r /etc/apt/apt.conf.d "$root/etc/apt/" 2>/dev/null || true
cp /etc/resolv.conf "$root/etc/resolv.conf" 2>/dev/null || true
# A minimal image leaves man pages out.
rm -f "$root"/etc/dpkg/dpkg.cfg.d/*

step "apt-get install man-db bash-completion"
inside apt-get -q update >/dev/null
inside apt-get -q -y install --no-install-recommends man-db bash-completion >/dev/null 2>&1
before=$(files)
inside dpkg --get-selections | sort >"$root/srv/packages"

step "apt-get install ./$(basename "$deb")"
cp "$deb" "$root/srv/"
inside apt-get -q -y install --no-install-recommends "/srv/$(basename "$deb")" >"$root/srv/install.log" 2>&1 ||
  { cat "$root/srv/install.log"; die "it cannot be installed"; }

step "README.md's quick start"
mkdir -p "$root/srv/home/scenarios"
cp "$top"/scenarios/quickstart.toml "$root/srv/home/scenarios/"
commands=$(sed -n '/^## Quick start/,/^The complete scenario/p' "$top/README.md" | grep '^palpate ')
inside bash -ec "cd /srv/home; $commands" >/dev/null
[[ -s $root/srv/home/out/quickstart/force_indentation.csv ]] || die "the quickstart wrote no curve"
inside bash -ec 'cd /srv/home; palpate run quickstart --out by_name --quiet
  cmp by_name/quickstart/force_indentation.csv out/quickstart/force_indentation.csv
  palpate new press; palpate run press.toml --quiet; palpate --version; palpate -V; palpate help run | grep -q dry-run'

step "man pages and completion"
for page in palpate palpate-emulator palpate-scenario; do
  inside man -P cat "$page" | grep -q "${page^^}" || inside man -P cat "$page" | grep -q "$page" || die "no page $page"
done
inside bash -c 'source /usr/share/bash-completion/bash_completion; _completion_loader palpate
  COMP_LINE="palpate ru"; COMP_POINT=${#COMP_LINE}; COMP_WORDS=(palpate ru); COMP_CWORD=1
  _palpate palpate ru palpate 2>/dev/null; [[ ${COMPREPLY[*]} == run ]]' || die "completion does not know \`run\`"

step "apt-get purge palpate"
inside apt-get -q -y purge palpate >/dev/null 2>&1
inside apt-get -q -y autoremove --purge >/dev/null 2>&1
left=$(comm -13 <(printf '%s\n' "$before") <(files) | grep -v -e '^etc/ld.so.cache' -e __pycache__ || true)
[[ -z $left ]] || die "it leaves behind: $left"
inside dpkg --get-selections | sort | diff "$root/srv/packages" - || die "it leaves packages behind"
step "nothing is left"
