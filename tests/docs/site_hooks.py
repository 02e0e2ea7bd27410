"""Hooks of mkdocs: README.md is the first page, files outside docs/ that a page links to come along,
and `palpate manual commands` is a page. The program is named by PALPATE."""

import os
import posixpath
import re
import subprocess
import tempfile
from pathlib import Path

from mkdocs.structure.files import File

TOP = Path(__file__).resolve().parents[2]
LINK = re.compile(r"\]\(([^)\s#]+)(#[^)\s]*)?\)")
generated = tempfile.TemporaryDirectory()


def repository_path(page):
    """Where a page of the site comes from, below the project's top."""
    if page == "index.md":
        return "README.md"
    return page[len("source/"):] if page.startswith("source/") else "docs/" + page


def page_path(path):
    """Where a file of the project goes in the site."""
    if path == "README.md":
        return "index.md"
    return path[len("docs/"):] if path.startswith("docs/") else "source/" + path


def targets(path, text):
    """Files of the project that a text links to."""
    for target, _ in LINK.findall(text):
        if ":" not in target:
            yield posixpath.normpath(posixpath.join(posixpath.dirname(path), target))


def on_files(files, config):
    def add(folder, name, path):
        file = File(name, str(folder), config["site_dir"], config["use_directory_urls"])
        file.abs_src_path = str(path)
        files.append(file)

    program = os.environ.get("PALPATE", "palpate")
    commands = subprocess.run([program, "manual", "commands"], check=True, stdout=subprocess.PIPE).stdout
    (Path(generated.name) / "commands.md").write_bytes(commands)
    add(generated.name, "commands.md", Path(generated.name) / "commands.md")
    waiting = ["README.md"] + ["docs/" + f.src_path for f in files.documentation_pages() if f.src_path != "commands.md"]
    known = set(waiting)
    while waiting:
        path = waiting.pop()
        if not path.startswith("docs/"):
            add(TOP, page_path(path), TOP / path)
        if not path.endswith(".md"):
            continue
        for target in targets(path, (TOP / path).read_text()):
            if target not in known and (TOP / target).is_file():
                known.add(target)
                if not target.startswith("docs/"):
                    waiting.append(target)
    return files


def on_page_markdown(markdown, page, config, files):
    here = repository_path(page.file.src_path)

    def moved(match):
        target, anchor = match.group(1), match.group(2) or ""
        if ":" in target:
            return match.group(0)
        path = posixpath.normpath(posixpath.join(posixpath.dirname(here), target))
        start = posixpath.dirname(page.file.src_path) or "."
        return "](" + posixpath.relpath(page_path(path), start) + anchor + ")"

    return markdown if page.file.src_path == "commands.md" else LINK.sub(moved, markdown)
