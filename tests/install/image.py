"""The image as src/image.sh packs it, from a small file system: image.py VERSION. Every hash and size is computed here
again, what docker and what OCI's tools read agree, and the layer gives back the file system. The recipe's version is VERSION."""

import gzip
import hashlib
import io
import json
import re
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
VERSION = sys.argv[1]


def blob(files, digest):
    """The bytes of a blob, which its name and its description must fit."""
    content = files["blobs/sha256/" + digest.removeprefix("sha256:")]
    assert digest == "sha256:" + hashlib.sha256(content).hexdigest(), digest
    return content


def described(files, descriptor, media_type):
    content = blob(files, descriptor["digest"])
    assert descriptor["size"] == len(content) and descriptor["mediaType"] == media_type, descriptor
    return content


with tempfile.TemporaryDirectory() as scratch:
    root, image = Path(scratch, "root.tar"), Path(scratch, "image.tar")
    with tarfile.open(root, "w") as tar:
        entry = tarfile.TarInfo("usr/bin/palpate")
        entry.size, entry.mode = 70000, 0o755
        tar.addfile(entry, io.BytesIO(bytes(range(250)) * 280))
    subprocess.run([TOP / "src/image.sh", "pack", root, VERSION, image], check=True)
    with tarfile.open(image) as tar:
        files = {member.name: tar.extractfile(member).read() for member in tar if member.isfile()}

    assert json.loads(files["oci-layout"]) == {"imageLayoutVersion": "1.0.0"}
    (entry,) = json.loads(files["index.json"])["manifests"]
    assert entry["annotations"]["org.opencontainers.image.ref.name"] == f"palpate:{VERSION}"
    manifest = json.loads(described(files, entry, "application/vnd.oci.image.manifest.v1+json"))
    config = json.loads(described(files, manifest["config"], "application/vnd.oci.image.config.v1+json"))
    (layer,) = manifest["layers"]
    unpacked = gzip.decompress(described(files, layer, "application/vnd.oci.image.layer.v1.tar+gzip"))
    assert unpacked == root.read_bytes()
    assert config["rootfs"] == {"type": "layers", "diff_ids": ["sha256:" + hashlib.sha256(unpacked).hexdigest()]}
    assert config["config"]["Entrypoint"] == ["palpate"] and config["os"] == "linux"

    (docker,) = json.loads(files["manifest.json"])
    assert docker["RepoTags"] == [f"palpate:{VERSION}"]
    assert json.loads(files[docker["Config"]]) == config
    assert [files[name] for name in docker["Layers"]] == [blob(files, layer["digest"])]
    assert len(files) == 6

recipe = (TOP / "docs/packaging/recipe.yaml").read_text()
assert re.search(r'^  version: "(.*)"$', recipe, re.MULTILINE)[1] == VERSION, "docs/packaging/recipe.yaml has another version"
print("docker and OCI read the same image")
