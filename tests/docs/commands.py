"""Runs the commands of the documents and compares what they print: commands.py PALPATE [PAGE... | --but PAGE...].

Run is every line of a fenced block that begins with `palpate ` or `python3 docs/`, with or without `$ `
before it, page by page, each page in a folder of its own in which scenarios/, materials/ and docs/ are
those of the project. The
exit code must be 0; `; echo $?` behind a command allows another. Compared is a block marked `text`
behind such a block, with all that its last command prints; a line `...` stands for any lines.

A comment before a block takes it out, `<!-- not run: REASON -->`, or some of its lines,
`<!-- not run, palpate chart --frames | palpate chart: REASON -->`, which names how they begin.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
COMMENT = re.compile(r"<!-- not run(?:, ([^:]+))?: .+ -->")
FENCE = re.compile(r"^ *```(\w*)")


def blocks(text):
    """The fenced blocks of a page: its mark, its first line's number, its lines, comments before it."""
    lines, comments, at = text.split("\n"), [], 0
    while at < len(lines):
        fence = FENCE.match(lines[at])
        if comment := COMMENT.match(lines[at].strip()):
            comments.extend(begin.strip() for begin in (comment.group(1) or "").split("|"))
        elif fence:
            start = at + 1
            at = next(i for i in range(start, len(lines)) if lines[i].strip() == "```")
            yield fence.group(1), start + 1, lines[start:at], comments
            comments = []
        elif lines[at].strip():
            comments = []
        at += 1


def commands(lines, left_out):
    """The commands of a block, with their line numbers in it."""
    joined, first = "", 0
    for number, line in enumerate(lines):
        joined, first = (joined + line, first) if joined else (line, number)
        if line.endswith("\\"):
            joined = joined[:-1]
            continue
        command, joined = joined.strip().removeprefix("$ "), ""
        if command.startswith(("palpate ", "python3 docs/")) and not any(command.startswith(skipped) for skipped in left_out):
            yield first, command


def same(wanted, got):
    """Whether lines are those wanted, of which `...` stands for any number."""
    parts = "\n".join(line.rstrip() for line in wanted).split("...")
    pattern = ".*".join(re.escape(part) for part in parts)
    return re.fullmatch(pattern, "\n".join(line.rstrip() for line in got), re.DOTALL)


def run_page(program, page):
    faults, count, compared = [], 0, 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for name in ("scenarios", "materials"):
            shutil.copytree(TOP / name, folder / name)
        (folder / "docs").symlink_to(TOP / "docs")
        (folder / "bin").mkdir()
        (folder / "bin/palpate").symlink_to(program)
        environment = {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}"}
        for name in ("CI", "DISPLAY", "WAYLAND_DISPLAY"):
            environment.pop(name, None)
        printed = None
        for mark, start, lines, left_out in blocks((TOP / page).read_text()):
            if mark == "text" and printed is not None:
                compared += 1
                if not same(lines, printed.rstrip("\n").split("\n")):
                    faults.append(f"{page}:{start}: not what is printed:\n{printed}")
            printed = None
            if mark not in ("", "sh", "console") or "" in left_out:
                continue
            for number, command in commands(lines, left_out):
                began = time.monotonic()
                done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
                printed, count = done.stdout, count + 1
                seconds = time.monotonic() - began
                if seconds > 2:
                    print(f"{page}:{start + number}: {seconds:.1f} s: {command}", flush=True)
                if done.returncode != 0:
                    faults.append(f"{page}:{start + number}: `{command}` ends with {done.returncode}:\n{printed}")
    return faults, count, compared


def main():
    program = Path(sys.argv[1]).resolve()
    pages = sys.argv[2:]
    if not pages or pages[0] == "--but":
        every = ["README.md", *sorted(str(p.relative_to(TOP)) for p in (TOP / "docs").rglob("*.md"))]
        pages = [page for page in every if page not in pages]
    all_faults, all_counts, all_compared = [], 0, 0
    for page in pages:
        faults, count, compared = run_page(program, page)
        all_faults += faults
        all_counts += count
        all_compared += compared
    print("\n".join(all_faults))
    print(f"{all_counts} commands run, {all_compared} outputs compared, {len(all_faults)} faults")
    sys.exit(bool(all_faults) or all_counts == 0)


if __name__ == "__main__":
    main()
