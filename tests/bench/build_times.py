#!/usr/bin/env python3
"""What the release build costs, in seconds of processor time: by room, by compilation, and by header.

usage: build_times.py FOLDER    builds the preset `release` anew in FOLDER and prints three tables

CMake starts every compiler through this file, which writes what it took into FOLDER/times.csv.
"""

import collections
import os
import re
import shutil
import subprocess
import sys
import tempfile

# Headers of libraries that many files include, or that take seconds each.
HEADERS = [
    "vector", "string", "map", "functional", "variant", "filesystem", "regex", "Eigen/Core", "Eigen/SparseCore", "Eigen/LU",
    "Eigen/Dense", "Eigen/Eigenvalues", "Eigen/SparseCholesky", "unsupported/Eigen/MatrixFunctions", "toml++/toml.h",
    "nlohmann/json.hpp", "CLI/CLI.hpp", "boost/asio.hpp", "boost/beast.hpp", "ceres/ceres.h", "OpenEXR/ImfOutputFile.h",
    "OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh", "tetgen.h", "CGAL/Surface_mesh.h", "Spectra/SymEigsSolver.h",
    "boost/math/tools/roots.hpp"
]


def run(command):
    """Runs a command; its processor time in s, and its exit code."""
    child = subprocess.Popen(command)
    _, status, used = os.wait4(child.pid, 0)
    return used.ru_utime + used.ru_stime, os.waitstatus_to_exitcode(status)


def launch(log, command):
    seconds, code = run(command)
    output = command[command.index("-o") + 1] if "-o" in command else ""
    with open(log, "a", encoding="utf-8") as file:
        file.write(f"{output},{seconds:.2f}\n")
    return code


def build(folder):
    log = os.path.join(folder, "times.csv")
    shutil.rmtree(folder, ignore_errors=True)
    launcher = f"{sys.executable};{os.path.abspath(__file__)};--launch;{log}"
    subprocess.run(["cmake", "--preset", "release", "-B", folder, f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}"],
                   check=True, stdout=subprocess.DEVNULL)
    open(log, "w", encoding="utf-8").close()  # without the compilers' own checks
    before = os.times()
    subprocess.run(["cmake", "--build", folder, "-j", str(os.cpu_count()), "--", "--quiet"], check=True,
                   stdout=subprocess.DEVNULL)
    after = os.times()
    with open(log, encoding="utf-8") as file:
        times = [(name, float(seconds)) for name, seconds in (line.strip().split(",") for line in file)]
    return times, after.elapsed - before.elapsed


def header_seconds(header):
    with tempfile.NamedTemporaryFile("w", suffix=".cpp") as source:
        source.write(f"#include <utility>\n#include <{header}>\n")
        source.flush()
        flags = ["-std=c++20", "-O2", "-fsyntax-only", "-isystem", "/usr/include/eigen3"]
        seconds, code = run(["c++", *flags, source.name])
    return seconds if code == 0 else None


def main():
    if len(sys.argv) > 3 and sys.argv[1] == "--launch":
        return launch(sys.argv[2], sys.argv[3:])
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    times, elapsed = build(sys.argv[1])
    rooms = collections.Counter()
    for name, seconds in times:
        room = re.search(r"palpate_([a-z]+)\.dir", name)
        rooms[room[1] if room else "programs"] += seconds
    print(f"{sum(rooms.values()):.0f} s of processor time in {len(times)} compilations; {elapsed:.0f} s by the clock\n")
    print("| room | s |\n|---|---|")
    for room, seconds in rooms.most_common():
        print(f"| {room} | {seconds:.0f} |")
    print("\n| compilation | s |\n|---|---|")
    for name, seconds in sorted(times, key=lambda row: -row[1])[:12]:
        print(f"| {name} | {seconds:.0f} |")
    print("\n| header, alone | s |\n|---|---|")
    for header in HEADERS:
        seconds = header_seconds(header)
        print(f"| {header} | {'not found' if seconds is None else format(seconds, '.1f')} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
