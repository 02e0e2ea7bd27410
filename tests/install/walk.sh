#!/usr/bin/env bash
# A newcomer's walk, three times: walk.sh PACKAGE.deb IMAGE.tar ARCHIVE.tar.gz. As root. Each is brought into a bare
# system in a folder, runs the quickstart as README.md writes it, draws its figure, is tried and removed again, and leaves
# nothing behind: the package on a Debian 12, the image by itself, the archive on a Debian 13. All three write the same table.
set -euo pipefail
deb=$(readlink -f "$1") image=$(readlink -f "$2") archive=$(readlink -f "$3")
top=$(dirname "$(readlink -f "$0")")/../..
scratch=$(mktemp -d)
commands=$(sed -n '/^## Quick start/,/^The complete scenario/p' "$top/README.md" | grep '^palpate ')
root=/nowhere

step() { printf '%4d s  %s\n' "$SECONDS" "$*"; }
die() { echo "walk.sh: $*" >&2; exit 1; }
inside() { chroot "$root" env -i PATH="${in_path:-/usr/sbin:/usr/bin:/sbin:/bin}" LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
files() { find "$root" -xdev -not -path "$root/proc/*" -not -path "$root/var/*" -not -path "$root/srv/*" -printf '%P\n' | sort; }
trap 'umount "$root/proc" 2>/dev/null || true; rm -rf "$scratch"' EXIT

# bare SUITE PACKAGE...: a minimal system of that Debian in the folder $root, from where this system's apt gets packages.
bare() {
  local suite=$1 file
  local -a sources=()
  shift
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
    if [[ -f $file ]] && grep -qE '(^|[ /])bookworm( |$)' "$file"; then
      sed "s/bookworm/$suite/g" "$file" >"$scratch/$suite-${file##*/}"
      sources+=("$scratch/$suite-${file##*/}")
    fi
  done
  root=$scratch/$suite
  step "mmdebstrap --variant=minbase --include=${*// /,} $suite"
  # A minimal image leaves man pages out, and has no processes to look at.
  mmdebstrap --variant=minbase --include="$*" "$suite" "$root" "${sources[@]}" >"$scratch/log" 2>&1 || { cat "$scratch/log"; die "no bare $suite"; }
  rm -f "$root"/etc/dpkg/dpkg.cfg.d/*
  cp -r /etc/apt/apt.conf.d "$root/etc/apt/" 2>/dev/null || true
  cp /etc/resolv.conf "$root/etc/resolv.conf" 2>/dev/null || true
  mount -t proc proc "$root/proc"
}

# The quickstart in the folder $1 of $root; its table is that of those before.
quickstart() {
  local results=$root/$1/out/quickstart
  mkdir -p "$root/$1/scenarios"
  cp "$top"/scenarios/quickstart.toml "$root/$1/scenarios/"
  step "README.md's quick start"
  inside bash -ec "cd '$1'; $commands" >/dev/null
  [[ -s $results/force_indentation.csv ]] || die "the quickstart wrote no curve"
  grep -q '</svg>' "$results/figure_force_indentation.svg" || die "the quickstart drew no figure"
  [[ -f $scratch/curve.csv ]] || cp "$results/force_indentation.csv" "$scratch/curve.csv"
  cmp "$results/force_indentation.csv" "$scratch/curve.csv"
  inside bash -ec "cd '$1'"'
    palpate run quickstart --out by_name --quiet
    cmp by_name/quickstart/force_indentation.csv out/quickstart/force_indentation.csv
    palpate new press; palpate run press.toml --quiet; palpate --version; palpate -V; palpate help run | grep -q dry-run
    palpate-emulator --help >/dev/null'
}

pages_and_completion() {
  local page
  step "man pages and completion"
  for page in palpate palpate-emulator palpate-scenario; do
    inside man -P cat "$page" | grep -qi "$page" || die "no page $page"
  done
  inside bash -c 'source /usr/share/bash-completion/bash_completion; _completion_loader palpate
    COMP_LINE="palpate ru"; COMP_POINT=${#COMP_LINE}; COMP_WORDS=(palpate ru); COMP_CWORD=1
    _palpate palpate ru palpate 2>/dev/null; [[ ${COMPREPLY[*]} == run ]]' || die "completion does not know \`run\`"
}

# nothing_left BEFORE: what the files of $root were.
nothing_left() {
  local left
  left=$(comm -13 <(printf '%s\n' "$1") <(files) | grep -v -e '^etc/ld.so.cache' -e __pycache__ || true)
  [[ -z $left ]] || die "it leaves behind: $left"
  umount "$root/proc"
  rm -rf "$root"
  step "nothing is left"
}

package() {
  local before
  bare bookworm man-db bash-completion
  inside apt-get -q update >/dev/null
  before=$(files)
  inside dpkg --get-selections | sort >"$root/srv/packages"
  step "apt-get install ./$(basename "$deb") gnuplot-nox"
  cp "$deb" "$root/srv/"
  inside apt-get -q -y install --no-install-recommends "/srv/$(basename "$deb")" gnuplot-nox >"$root/srv/install.log" 2>&1 ||
    { cat "$root/srv/install.log"; die "it cannot be installed"; }
  inside apt-mark -q auto gnuplot-nox >/dev/null  # as a recommended package is
  quickstart srv/home
  pages_and_completion
  step "apt-get purge palpate"
  inside apt-get -q -y purge palpate >/dev/null 2>&1
  inside apt-get -q -y autoremove --purge >/dev/null 2>&1
  inside dpkg --get-selections | sort | diff "$root/srv/packages" - || die "it leaves packages behind"
  nothing_left "$before"
}

image() {
  local layer
  local -a podman=(podman --root "$scratch/podman" --runroot "$scratch/podman-run" --storage-driver=vfs --cgroup-manager=cgroupfs)
  root=$scratch/image
  step "the file system of $(basename "$image"), $(($(stat -c %s "$image") / 1000000)) MB"
  (($(stat -c %s "$image") < 250000000)) || die "it is above 250 MB"
  layer=$(tar -xOf "$image" manifest.json | sed 's/.*"Layers": \["\([^"]*\)"\].*/\1/')
  mkdir "$root"
  tar -xOf "$image" "$layer" | tar -xzp -C "$root"
  if grep -rqs '://' "$root/etc/apt"; then die "it names a mirror"; fi
  mount -t proc proc "$root/proc"
  quickstart work
  umount "$root/proc"
  rm -rf "$root"
  command -v podman >/dev/null || { step "without podman: not loaded"; return; }
  # crun refuses some arrangements of control groups that runc takes.
  ! command -v runc >/dev/null || podman+=(--runtime "$(command -v runc)")
  step "podman load; podman run palpate run quickstart"
  "${podman[@]}" load -q -i "$image" >"$scratch/log" 2>&1 || { cat "$scratch/log"; die "podman does not load it"; }
  mkdir "$scratch/mine"
  if "${podman[@]}" run --rm --network=none --ulimit nofile=1024:1024 --ulimit nproc=1024:1024 -v "$scratch/mine:/work" \
    palpate:"$(dpkg-deb -f "$deb" Version)" run quickstart --quiet >"$scratch/log" 2>&1; then
    cmp "$scratch/mine/out/quickstart/force_indentation.csv" "$scratch/curve.csv"
    [[ -s $scratch/mine/out/quickstart/figure_force_indentation.svg ]] || die "podman's quickstart drew no figure"
  else
    step "podman loads it, but runs nothing here: $(tail -n 1 "$scratch/log")"
  fi
  "${podman[@]}" rmi -a >/dev/null
  [[ -z $("${podman[@]}" images -q) ]] || die "podman keeps it"
  step "nothing is left"
}

archive() {
  local before
  bare trixie man-db bash-completion gnuplot-nox
  before=$(files)
  step "tar -xzf $(basename "$archive")"
  tar -xzf "$archive" -C "$root/opt" --no-same-owner
  in_path=/opt/$(basename "$archive" .tar.gz)/bin:/usr/sbin:/usr/bin:/sbin:/bin
  quickstart srv/home
  pages_and_completion
  step "rm -r"
  rm -r "${root:?}/opt/$(basename "$archive" .tar.gz)"
  nothing_left "$before"
}

package
image
archive
