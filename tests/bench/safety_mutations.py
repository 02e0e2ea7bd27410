#!/usr/bin/env python3
"""Breaks one safety rule of the devices at a time and sees whether its test program fails.

    safety_mutations.py BUILD [--only WORD]

BUILD is a build folder of its own, such as build/mutations, in which warnings are no errors. Each mutation
replaces one line of src/device, rebuilds the test program of the room, runs it, and puts the line back. The
exit code is 1 if a rule can be broken without a failing test, or a mutation does not compile.
"""
import argparse
import os
import subprocess
import sys

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "src", "device")
PROGRAM = "unit_device"
# File, line, what it becomes.
MUTATIONS = [
    ("safety.cpp", "armed_ = trip_ == Trip::none;", "armed_ = true;"),
    ("safety.cpp", "  armed_ = false;\n  if (trip_", "  if (trip_"),
    ("safety.cpp", "if (trip_ == Trip::none) trip_ = why;", ""),
    ("safety.cpp", "return force.allFinite() ? force : Vec3::Zero();", "return force;"),
    ("safety.cpp", "if (norm <= most) return force;", "return force;"),
    ("safety.cpp", "if (!(largest > 0.0)) return Vec3::Zero();", ""),
    ("safety.cpp", "clamped_norm(wanted - last_, rate * std::max(0.0, dt))", "wanted - last_"),
    ("safety.cpp", "rate * std::max(0.0, dt)", "rate * dt"),
    ("safety.cpp", "if (!(depth <= 0.0)) return false;", ""),
    ("safety.cpp", "if (!(depth <= 0.0)) return false;", "if (depth > 0.0) return false;"),
    ("safety.cpp", "if (!started_) return 0.0;", "if (!started_) return 1.0;"),
    ("safety.cpp", "return std::clamp((now - begin_) / time_, 0.0, 1.0);", "return 1.0;"),
    ("safety.cpp", "age > rule_.lost_after) {", "false) {"),
    ("safety.cpp", "arrival == Arrival::lost || age", "age"),
    ("safety.cpp", "arrival != Arrival::fresh && age > rule_.stale_after ?", "false ?"),
    ("safety.cpp", "gain_ = std::min(1.0, gain_ + dt / rule_.rise);", "gain_ = 1.0;"),
    ("safety.cpp", "if (!position.allFinite()) return false;", ""),
    ("safety.cpp", "if (any_ && (position - last_).norm() > reach) return false;", ""),
    ("stand_safety.cpp", "std::isfinite(sample.force) &&", ""),
    ("stand_safety.cpp", "if (jumps_ >= 2) arming_.trip(Trip::jump);", ""),
    ("stand_safety.cpp", "if (std::abs(sample.force) > rules_.force)", "if (sample.force > rules_.force)"),
    ("stand_safety.cpp", "z < rules_.low - rules_.slack ||", ""),
    ("stand_safety.cpp", "|| z > rules_.high + rules_.slack", ""),
    ("stand_safety.cpp", "if (sample.fault == Fault::overload) arming_.trip(Trip::overload);", ""),
    ("stand_safety.cpp", "== Staleness::State::lost) arming_.trip(Trip::link_lost);",
     "== Staleness::State::lost) {}"),
    ("stand_safety.cpp", "if (arming_.tripped() != Trip::none) return Verdict::stop;", ""),
    ("stand_safety.cpp", "State::stale ? Verdict::halt : Verdict::go_on", "State::stale ? Verdict::go_on : "
     "Verdict::go_on"),
    ("stand_safety.cpp", "if (limits_in_device != Fault::none || !any_) return false;", ""),
    ("stand_safety.cpp", "if (z < rules_.low || z > rules_.high) return false;", ""),
    ("stand_safety.cpp", "if (!arming_.armed() || staleness_.state() != Staleness::State::fresh) return none;",
     ""),
    ("stand_safety.cpp", "if (wanted.act == Motion::Act::down && z <= rules_.low) return none;", ""),
    ("stand_safety.cpp", "if (wanted.act == Motion::Act::up && z >= rules_.high) return none;", ""),
    ("stand_safety.cpp", "std::min(wanted.speed, rules_.fastest)", "wanted.speed"),
    ("arm_safety.cpp", "good && !jump_.takes(now, sample.position)", "false"),
    ("arm_safety.cpp", "sample.fault == Fault::brake ||", ""),
    ("arm_safety.cpp", "sample.fault == Fault::stalled ||", ""),
    ("arm_safety.cpp", "sample.fault == Fault::unstable)", "false)"),
    ("arm_safety.cpp", "if (staleness_.state() == Staleness::State::lost) arming_.trip(Trip::link_lost);", ""),
    ("arm_safety.cpp", "if (!arming_.armed() || !any_) return 0.0;", ""),
    ("arm_safety.cpp", "start_.gain(now) * staleness_.gain()", "staleness_.gain()"),
    ("arm_safety.cpp", "start_.gain(now) * staleness_.gain()", "start_.gain(now)"),
    ("arm_safety.cpp", "++counts_.outside;\n    gain = 0.0;", "++counts_.outside;"),
    ("arm_safety.cpp", "++counts_.too_fast;\n    gain = 0.0;", "++counts_.too_fast;"),
    ("arm_safety.cpp", "    slew_.drop();\n", ""),
    ("arm_safety.cpp", "share * clamped_norm(finite_or_zero(wanted), rules_.force)",
     "share * finite_or_zero(wanted)"),
    ("arm_safety.cpp", "force = clamped_norm(finite_or_zero(force), rules_.force);", ""),
    ("arm_safety.cpp", "slew_.step(force, dt, rate)", "force"),
    ("arm_safety.cpp", "falls ? std::max(rules_.slew, rules_.force / rules_.stale.fall) : rules_.slew",
     "rules_.slew"),
    ("passivity.cpp", "energy_ -= force.dot(position - last_);", ""),
    ("passivity.cpp", "std::min(most_, -observer.energy() / power)", "-observer.energy() / power"),
    ("stop_guard.cpp", "  write_packed(file, closing_bytes.load());\n", ""),
    ("stop_guard.cpp", "  write_packed(file, stop_bytes.load());\n", ""),
    ("stop_guard.cpp", "if (errno == EAGAIN) ::tcflush(file, TCOFLUSH);", ""),
    ("stop_guard.cpp", "  static const int registered = std::atexit(send_stop);\n  (void)registered;\n", ""),
    ("stop_guard.cpp", "  send_stop();\n  stop_file = watched", "  stop_file = watched"),
    ("stop_guard.cpp", "|| info->si_pid == watched_child", ""),
    ("stop_guard.cpp", "SA_SIGINFO | SA_RESTART | SA_ONSTACK", "SA_SIGINFO | SA_RESTART"),
    ("stop_guard.cpp", "return signal == SIGTSTP ||", "return"),
    ("guard_process.cpp", "now - heard > GuardProcess::silence && stops.due(now)", "false"),
    ("guard_process.cpp", "  for (stops = Stops(line); !stops.over(); ::poll(nullptr, 0, look_time))\n"
     "    if (const double now = wire_time(); stops.due(now)) stops.send(now);\n", ""),
    ("guard_process.cpp", "  ::sigfillset(&all);\n", "  ::sigemptyset(&all);\n"),
]


def outcome(build):
    """`kept` if the test program fails, `broken` if it passes, `idle` if it cannot be built."""
    made = subprocess.run(["cmake", "--build", build, "--target", PROGRAM, "--", "--quiet"],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if made.returncode != 0:
        return "idle"
    try:
        ended = subprocess.run([os.path.join(build, PROGRAM)], stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL, timeout=120)
    except subprocess.TimeoutExpired:
        return "kept"
    return "kept" if ended.returncode != 0 else "broken"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    options.build = os.path.abspath(options.build)
    # A warning about what a mutation leaves unused is no test of it.
    subprocess.run(["cmake", "--preset", "dev", "-B", options.build, "-D", "CMAKE_UNITY_BUILD=OFF",
                    "-D", "CMAKE_COMPILE_WARNING_AS_ERROR=OFF"], check=True, stdout=subprocess.DEVNULL,
                   cwd=os.path.join(SOURCE, "..", ".."))
    if outcome(options.build) != "broken":
        sys.exit("the tests of the room fail before any rule is broken")
    counts = {"kept": 0, "broken": 0, "idle": 0}
    for file, old, new in MUTATIONS:
        if options.only not in file:
            continue
        path = os.path.join(SOURCE, file)
        text = open(path).read()
        if text.count(old) < 1:
            sys.exit("%s has no line `%s`; put the mutation right" % (file, old))
        try:
            open(path, "w").write(text.replace(old, new, 1))
            result = outcome(options.build)
        finally:
            open(path, "w").write(text)
        counts[result] += 1
        if result != "kept":
            print("%s: %s: `%s` -> `%s`" % (result, file, old, new), flush=True)
    print("%(kept)d rules broken and seen by a test, %(broken)d not seen, %(idle)d not built" % counts)
    return 1 if counts["broken"] or counts["idle"] else 0


if __name__ == "__main__":
    sys.exit(main())
