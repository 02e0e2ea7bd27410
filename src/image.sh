#!/usr/bin/env bash
# The image of `./dev image`. `image.sh root PACKAGE.deb ROOT.tar` makes a small Debian 12 with the package and gnuplot
# in it; `image.sh pack ROOT.tar VERSION IMAGE.tar` packs that as an OCI layout of one layer that has docker's
# manifest.json as well, so that docker, podman and apptainer take it.
set -euo pipefail
die() { echo "image.sh: $*" >&2; exit 1; }

# The image keeps no address of a mirror: what this system's apt uses is read, and removed from the image.
root() {
  local package=$1 tar=$2 file
  local -a sources=()
  for file in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
    if [[ -f $file ]] && grep -qE '(^|[ /])bookworm( |$)' "$file"; then sources+=("$file"); fi
  done
  mmdebstrap --variant=essential --include=gnuplot-nox --include="$(readlink -f "$package")" \
    --hook-dir=/usr/share/mmdebstrap/hooks/file-mirror-automount \
    --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
    --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-include=/usr/share/doc/*/copyright' \
    --customize-hook='mkdir -p "$1/work"' \
    --customize-hook='rm -rf "$1"/etc/apt/sources.list* "$1/etc/resolv.conf" "$1/etc/hostname"' \
    bookworm "$tar" "${sources[@]}"
}

# blob FILE: moves it to where its hash says, and prints the hash.
blob() {
  local hash
  hash=$(sha256sum "$1")
  hash=${hash%% *}
  mv "$1" "$layout/blobs/sha256/$hash"
  echo "$hash"
}

pack() {
  local tar=$1 version=$2 image=$3 architecture unpacked layer config manifest
  layout=$(mktemp -d)
  trap 'rm -rf "$layout"' EXIT
  mkdir -p "$layout/blobs/sha256"
  size() { stat -c %s "$layout/blobs/sha256/$1"; }
  architecture=$(dpkg --print-architecture)
  unpacked=$(sha256sum "$tar")
  gzip -nc "$tar" >"$layout/layer"
  layer=$(blob "$layout/layer")
  cat >"$layout/config" <<JSON
{"architecture": "$architecture", "os": "linux",
 "config": {"Entrypoint": ["palpate"], "Cmd": ["help"], "WorkingDir": "/work",
            "Env": ["PATH=/usr/local/bin:/usr/bin:/bin", "LC_ALL=C.UTF-8"],
            "Labels": {"org.opencontainers.image.title": "palpate", "org.opencontainers.image.version": "$version",
                       "org.opencontainers.image.licenses": "AGPL-3.0-or-later"}},
 "rootfs": {"type": "layers", "diff_ids": ["sha256:${unpacked%% *}"]},
 "history": [{"created_by": "./dev image"}]}
JSON
  config=$(blob "$layout/config")
  cat >"$layout/manifest" <<JSON
{"schemaVersion": 2, "mediaType": "application/vnd.oci.image.manifest.v1+json",
 "config": {"mediaType": "application/vnd.oci.image.config.v1+json", "digest": "sha256:$config", "size": $(size "$config")},
 "layers": [{"mediaType": "application/vnd.oci.image.layer.v1.tar+gzip", "digest": "sha256:$layer", "size": $(size "$layer")}]}
JSON
  manifest=$(blob "$layout/manifest")
  cat >"$layout/index.json" <<JSON
{"schemaVersion": 2, "mediaType": "application/vnd.oci.image.index.v1+json",
 "manifests": [{"mediaType": "application/vnd.oci.image.manifest.v1+json", "digest": "sha256:$manifest",
                "size": $(size "$manifest"), "annotations": {"org.opencontainers.image.ref.name": "palpate:$version"}}]}
JSON
  echo '{"imageLayoutVersion": "1.0.0"}' >"$layout/oci-layout"
  cat >"$layout/manifest.json" <<JSON
[{"Config": "blobs/sha256/$config", "RepoTags": ["palpate:$version"], "Layers": ["blobs/sha256/$layer"]}]
JSON
  tar -C "$layout" --sort=name --owner=0 --group=0 --numeric-owner -cf "$image" \
    blobs index.json manifest.json oci-layout
}

case ${1:-} in
  root | pack) "$@" ;;
  *) die "give \`root\` or \`pack\`" ;;
esac
