"""Builds the site with mkdocs and checks it: site.py PALPATE SITE_FOLDER. Every link and every part of
a page that a link names is there, the search's index knows every page, and its page lists what it finds
in Chromium."""

import json
import os
import subprocess
import sys
import threading
from functools import partial
from html.parser import HTMLParser
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
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


# Tells the server when the search, which runs in a thread of its own, has put its answer into the page.
WATCH = b"""<img src="held.png"><script>
const results = document.getElementById('mkdocs-search-results');
const told = () => { if (results.textContent.trim()) fetch('answered'); };
new MutationObserver(told).observe(results, {childList: true, subtree: true});
told();
</script></body>"""


class Server(SimpleHTTPRequestHandler):
    """The site, and its first page once more as /searched.html, with a picture that comes when the search has
    answered: Chromium prints a page when its pictures are there."""

    answered = threading.Event()

    def do_GET(self):
        if self.path == "/held.png":
            self.answered.wait(100)
            self.send_error(404)
        elif self.path == "/answered":
            self.answered.set()
            self.send_error(404)
        elif self.path.startswith("/searched.html"):
            self.answered.clear()
            text = (Path(self.directory) / "index.html").read_bytes()
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(text.replace(b"</body>", WATCH))
        else:
            super().do_GET()

    def log_message(self, *_):
        pass


def browser_faults(site):
    """What Chromium shows for a search: its index is read by a script, which needs a server."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Server, directory=str(site)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    for wanted, shown in (("saltelli", "theory.html#sensitivity-of-a-sweep"), ("nonsenseword", "No results found</p>")):
        address = f"http://127.0.0.1:{server.server_port}/searched.html?q={wanted}"
        page = subprocess.run(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", address],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, timeout=120, check=True,
        ).stdout
        if shown not in page.partition('id="mkdocs-search-results"')[2].partition("modal-footer")[0]:
            yield f"in Chromium the search for `{wanted}` does not show `{shown}`"
    server.shutdown()


def main():
    program, site = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    subprocess.run(
        ["mkdocs", "build", "--config-file", str(TOP / "tests/docs/mkdocs.yml"), "--strict", "--quiet", "--clean", "--site-dir", str(site)],
        cwd=TOP,
        env={**os.environ, "PALPATE": str(program), "PYTHONDONTWRITEBYTECODE": "1"},
        check=True,
    )
    found = [*faults(site), *search_faults(site), *browser_faults(site)]
    print("\n".join(found) or f"{len(list(site.rglob('*.html')))} pages: all links and the search are good")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
