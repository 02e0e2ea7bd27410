"""Counts words without a standard meaning in what people read: words.py PALPATE.

Read are the help of every verb, the manual, the documents, the comments and titles of scenarios, all sentences in the sources (which
become messages, columns and pages) and the names of keys and columns. Each pattern is a word of docs/style.md's table in the sense
that the table gives up; the same letters in another sense (`touches`, a stand's `travel`, the tissue skin) are no match.
"""

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]

# In sentences: the word, and what a sentence says instead.
SENTENCES = {
    r"(?<!without )travels?|travelled": "displacement",
    r"sinking|sinks|sank": "surface displacement",
    r"skin of (?:the|a) mesh|mesh's skin|on the skin's surface": "surface",
    r"rungs?|ladders?": "model",
    r"lattices?": "structured mesh",
    r"(?:this|the|a|small) networks?": "springs",
    r"creases?": "sharp edge",
    r"lumps?|lumpy": "inclusion",
    r"slabs?": "layer",
    r"(?:loading )?programmes?": "loading history",
    r"remarks?": "warning",
    r"(?:are|is|were|was|be|been|what it|what they|points|rows|cases) left out|left out:|leaves? out|leaving out": "neglected, excluded",
    r"tied": "not separately identifiable",
    r"worth": "effective sample size",
    r"radiat\w+ waves": "inertia",
    r"drag against|mass drag|the drag": "nodal drag, friction",
    r"ambient (?:force|load)": "tare",
    r"crept(?: load)?": "equivalent static load",
    r"(?:in|by|asks?|of) statics|statics (?:asks?|needs?|uses?)": "static solution",
    r"(?:first|its|the) touch|touch of": "contact",
    r"the foot of|feet of": "closest point",
    r"bless\w*": "update",
    r"(?:the|an|its|first|page with) answers?": "result",
    r"(?:body|mesh|tissue|it) rings": "vibrates",
    r"findings|(?:the|a|one|per|new) finding": "derived quantity",
    r"(?:is|are|be) held(?! (?:for|between|by another|longer)|[.\"]|, then)|held (?:part|share|side)s?": "fixed",
    r"edge ring|ring of the part": "boundary of the active neighbourhood",
}
ANY = re.compile(r"(?<![\w/.=\"-])(?:" + "|".join(SENTENCES) + r")(?![\w/(=-]|\.\w)", re.I)
EACH = {re.compile(pattern, re.I): instead for pattern, instead in SENTENCES.items()}
# In keys and columns, as a part between underscores.
NAMES = {"travel", "sinking", "rung", "ladder", "lattice", "network", "lump", "slab", "programme", "remark", "tied", "worth", "drag",
         "ambient", "crept", "statics", "touch", "foot", "bless", "answer", "ring", "rings", "patch", "stretch", "balance"}

# The exceptions, each with its reason: decisions.md, 466.
KEPT_NAMES = {
    "travel_mm", "peak_travel_mm", "measured_travel_mm",  # columns of the design
    "ambient_N", "ambient_force", "rings", "curvature_rings", "drag", "nodal_drag", "slab",  # keys and values of the design and its cases
}
STANDS = ("docs/devices.md", "docs/emulator.md", "src/device/", "src/live/", "src/emulator/", "src/measured/", "scenarios/gauges/",
          "scenarios/emulator/", "src/cli/device_verb.cpp", "src/cli/live_verb.cpp", "src/report/export.cpp")


def sentences_of_sources():
    """Each literal of the sources with a space in it, adjacent ones joined."""
    for path in sorted(TOP.glob("src/**/*")):
        if path.suffix not in (".cpp", ".h"):
            continue
        text = re.sub(r"(?m)(?<![:\"'])//.*$", "", path.read_text())
        text = re.sub(r'(?<!\\)"\s*\n\s*"', "", text)
        for literal in re.finditer(r'"((?:[^"\\\n]|\\.)*)"|R"\w*\((.*?)\)\w*"', text, re.S):
            words = literal.group(1) or literal.group(2) or ""
            if " " in words:
                yield str(path.relative_to(TOP)), words.replace("\\n", " ").replace('\\"', '"')
            elif re.fullmatch(r"[A-Za-z]\w*_\w+|[a-z]+", words):
                yield str(path.relative_to(TOP)) + " name", words


def help_texts(palpate):
    """The help of every verb and of the verbs below it."""
    def text_of(*words):
        return subprocess.run([palpate, *words], capture_output=True, text=True, check=True).stdout

    def verbs(text):
        return [line.split()[0] for part in re.split(r"\n\n(?!Options|Positionals|Exit)", text)[1:] if re.match(r"[A-Z][\w ]+:\n", part)
                for line in part.split("\n")[1:] if re.match(r"  [a-z]", line)]

    top = text_of("--help")
    yield "palpate --help", top
    for verb in verbs(top):
        text = text_of(verb, "--help")
        yield f"palpate {verb} --help", text
        if "SUBCOMMAND" in text:
            for below in verbs(text):
                yield f"palpate {verb} {below} --help", text_of(verb, below, "--help")
    for page in ("keys", "commands"):
        yield f"palpate manual {page}", text_of("manual", page)


def documents():
    for pattern in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "docs/*.md", "docs/howto/*", "scenarios/**/*.toml"):
        for path in sorted(TOP.glob(pattern)):
            if path.name == "style.md":
                continue  # the table itself
            yield str(path.relative_to(TOP)), path.read_text()


def headers():
    for path in sorted(TOP.glob("golden/**/*.csv")):
        yield str(path.relative_to(TOP)), path.read_text().split("\n")[0].split(",")


def faults_of_text(place, text):
    """Back-quoted names, links, paths, quotations of the paper's title and of lines are no sentences."""
    bare = re.sub(r"`[^`\n]*`|\]\([^)]*\)|<!--.*?-->|touch-enabled", " ", text, flags=re.S)
    bare = re.sub(r"```.*?```", " ", bare, flags=re.S)
    for match in ANY.finditer(bare):
        instead = next(instead for pattern, instead in EACH.items() if pattern.search(bare, match.start(), match.end()))
        around = bare[max(0, match.start() - 50):match.end() + 30].replace("\n", " ")
        if not (instead == "displacement" and place.startswith(STANDS)) and bare != "golden bless":  # what a stand reports; an old verb
            yield f"{place}: `{match.group()}` ({instead}): ...{around}..."


def faults_of_name(place, name):
    parts = set(re.split(r"[_.]", name.lower()))
    if name.split(".")[-1] not in KEPT_NAMES and not place.startswith(STANDS) and parts & NAMES:
        yield f"{place}: the name `{name}`"


def main():
    palpate = sys.argv[1]
    read, faults = Counter(), []
    for kind, texts in (("help and manual", help_texts(palpate)), ("documents", documents())):
        for place, text in texts:
            read[kind] += len(text.split())
            faults += faults_of_text(place, text)
    for place, text in sentences_of_sources():
        read["sources"] += len(text.split())
        if place.endswith(" name"):
            faults += faults_of_name(place, text)
        else:
            faults += faults_of_text(place, text)
    for place, names in headers():
        read["columns"] += len(names)
        for name in names:
            faults += faults_of_name(place, name)
    for fault in faults:
        print(fault)
    print(f"{len(faults)} words without a standard meaning in " + ", ".join(f"{count} words of {kind}" for kind, count in read.items()))
    return 1 if faults or min(read.values()) < 500 else 0


if __name__ == "__main__":
    sys.exit(main())
