// A run of the stand in lock-step that is held at a moment of the emulator's time: the reply that
// it waits for does not come, and no time passes, until the test has done what it wants.
#pragma once

#include <algorithm>
#include <csignal>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "live_session.h"

namespace palpate::test {

class HeldRun {
 public:
  // Held `at` a time of the emulator, as "1.2 s"; `more` are words of the run.
  explicit HeldRun(const std::string& at, const std::vector<std::string>& more,
                   const std::string& tissue = "surface = \"-2 mm\"\n")
      : tissue_(tissue),
        stall_("[[fault]]\nkind = \"stall\"\nduration = \"10 ms\"\nat = \"" + at + "\"\n"),
        stand_({"mark10", "--clock", "virtual", "--tissue", tissue_.path(), "--fault",
                stall_.path(), "--log", log_}),
        port_(stand_.port()),  // before the run holds it alone
        run_(call(more)) {}

  // Stops the run's process there. False if it ends before, or if this comes so late that the run
  // has given the reply up (Mark10::patience, half a second) and goes on.
  bool hold() {
    if (!run_.until([&] { return has(read_file(log_), fault); })) return false;
    run_.send(SIGSTOP);
    siginfo_t info{};
    ::waitid(P_PID, static_cast<id_t>(run_.id()), &info, WSTOPPED | WEXITED | WNOWAIT);
    const std::string since = after_fault();
    const std::string request = ",in,";  // one is that which got no reply
    return info.si_code == CLD_STOPPED &&
           since.find(request, since.find(request) + 1) == since.npos;
  }
  // To the process, which then goes on where the signal lets it.
  void send(int signal) {
    if (signal == SIGTSTP) run_.send(SIGCONT);  // which would take it back
    run_.send(signal);
    if (signal != SIGTSTP && signal != SIGSTOP) run_.send(SIGCONT);
  }
  void go_on() { run_.send(SIGCONT); }
  // Whether a stop has come to the stand since.
  [[nodiscard]] bool is_stopped() const { return has(after_fault(), ",in,\"s\","); }
  // Readings of another client: the stand's time goes on by 20 ms with each.
  void pass(int readings) const {
    port_.say(std::string(static_cast<std::size_t>(readings), 'n'));
    (void)port_.lines(2 * readings);
  }
  [[nodiscard]] double position() const { return last_in_log(log_, "position_m"); }
  [[nodiscard]] bool moves() const { return last_in_log(log_, "velocity_m_s") != 0.0; }

  [[nodiscard]] pid_t guard() const { return guard_of(run_); }
  Running& run() { return run_; }
  nlohmann::json summary() { return stand_.end().at("summary"); }
  [[nodiscard]] std::string link() const { return "mark10:" + stand_.port(); }
  [[nodiscard]] const fs::path& folder() const { return folder_.path(); }

 private:
  static constexpr const char* fault = ",fault,\"stall\",";
  [[nodiscard]] std::string after_fault() const {
    const std::string log = read_file(log_);
    return log.substr(std::min(log.find(fault), log.size()));
  }
  [[nodiscard]] Invocation call(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"run",
                                   project_file("scenarios/device_stand.toml"),
                                   "--device",
                                   link(),
                                   "--clock",
                                   "virtual",
                                   "--arm",
                                   "--set",
                                   "output.figures=false"};
    words.insert(words.end(), more.begin(), more.end());
    return {.arguments = words, .folder = folder_.path()};
  }

  TemporaryFolder folder_;
  std::string log_ = (folder_ / "log.csv").string();
  ScratchFile tissue_;
  ScratchFile stall_;
  LiveEmulator stand_;
  emulator::test::Port port_;
  Running run_;
};

// A run that is held; a test that came too late tries again.
inline std::unique_ptr<HeldRun> held_run(const std::string& at,
                                         const std::vector<std::string>& more,
                                         const std::string& tissue = "surface = \"-2 mm\"\n") {
  for (int i = 0; i < runs_by_the_clock; ++i)
    if (auto run = std::make_unique<HeldRun>(at, more, tissue); run->hold()) return run;
  throw std::runtime_error("no run could be held at " + at);
}

// In the press from -2 mm to -4 mm at 1 mm/s, some 0.5 mm down.
inline std::unique_ptr<HeldRun> held_press() {
  return held_run("1.6 s", {"--surface", "-2 mm", "--set", "step.1.rate=1 mm/s"});
}

}  // namespace palpate::test
