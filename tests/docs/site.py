"""Builds the site with mkdocs and checks it: site.py PALPATE SITE_FOLDER. Every link and every part of
a page that a link names is there, and the search finds each page by its title."""

import json
import os
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

TOP = Path(__file__).resolve().parents[2]


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.names = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.names.update(given[key] for key in ("id", "name") if given.get(key))
        self.links.extend(given[key] for key in ("href", "src") if given.get(key))


def faults(site):
    pages = {path: Page(path.read_text()) for path in site.rglob("*.html")}
    for path, page in sorted(pages.items()):
        if path.name == "404.html":  # its links are those of a server's top folder
            continue
        for link in page.links:
            if link.startswith(("http:", "https:", "mailto:", "data:", "javascript:")):
                continue
            target, _, part = unquote(link).partition("#")
            file = (path.parent / target.partition("?")[0]).resolve() if target else path
            if file.is_dir():
                file = file / "index.html"
            if not file.is_file():
                yield f"{path.relative_to(site)}: the link to `{link}` leads nowhere"
            elif part and file in pages and part not in pages[file].names:
                yield f"{path.relative_to(site)}: `{link}` names a part that is not there"


def search_faults(site):
    entries = json.loads((site / "search/search_index.json").read_text())["docs"]
    words = " ".join(entry["title"] + " " + entry["text"] for entry in entries)
    for wanted in ("tutorial", "young_modulus", "--dry-run", "completion", "Hertz", "saltelli"):
        if wanted.lower() not in words.lower():
            yield f"the search does not know `{wanted}`"
    for path in site.glob("*.html"):
        if path.name not in ("404.html", "search.html") and not any(
            entry["location"].partition("#")[0] in (path.name, "" if path.name == "index.html" else path.name)
            for entry in entries
        ):
            yield f"the search does not know {path.name}"


def main():
    program, site = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    subprocess.run(
        ["mkdocs", "build", "--strict", "--quiet", "--clean", "--site-dir", str(site)],
        cwd=TOP,
        env={**os.environ, "PALPATE": str(program), "PYTHONDONTWRITEBYTECODE": "1"},
        check=True,
    )
    found = [*faults(site), *search_faults(site)]
    print("\n".join(found) or f"{len(list(site.rglob('*.html')))} pages: all links and the search are good")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
