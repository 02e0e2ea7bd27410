// `palpate run --device` against the emulator: one session, and what both sides say of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/text.h"
#include "live_emulator.h"
#include "program.h"
#include "record/csv.h"

namespace palpate::test {

struct Session {
  std::string link = "mark10";  // or inverse3
  std::string scenario = "device_stand";
  std::string clock = "virtual";
  std::vector<std::string> emulator = {};  // options
  std::vector<std::string> options = {"--arm"};
  std::string surface =
      {};  // empty: where the emulator's tissue begins, 20 mm below a hand's start
};

// A table's numbers by column.
class Rows {
 public:
  Rows() = default;
  explicit Rows(record::Table table) : table_(std::move(table)) {}
  [[nodiscard]] std::size_t size() const { return table_.rows.size(); }
  [[nodiscard]] double number(std::size_t row, const std::string& column) const {
    const auto* value = std::get_if<double>(&at(row, column));
    return value != nullptr ? *value : std::nan("");
  }
  [[nodiscard]] std::string word(std::size_t row, const std::string& column) const {
    const auto* value = std::get_if<std::string>(&at(row, column));
    return value != nullptr ? *value : std::string();
  }

 private:
  [[nodiscard]] const record::Cell& at(std::size_t row, const std::string& column) const {
    const int found = table_.find(column);
    if (found < 0) throw std::out_of_range("no column " + column);
    return table_.rows.at(row).at(static_cast<std::size_t>(found));
  }
  record::Table table_;
};

// The stand's run by the machine's clock, as a process of its own: it presses from -2 mm to -4 mm.
inline Invocation stand_run(const fs::path& folder, const LiveEmulator& stand,
                            const std::string& speed) {
  return {.arguments = {"run", project_file("scenarios/device_stand.toml"), "--device",
                        "mark10:" + stand.port(), "--arm", "--surface", "-2 mm", "--set",
                        "output.figures=false", "--set", "step.1.rate=" + speed},
          .folder = folder};
}

// The child of a run that is named as the guard. Throws where there is none: 0 and -1 would be
// many.
inline pid_t guard_of(const Running& run) {
  const std::string id = std::to_string(run.id());
  pid_t child = -1;
  std::ifstream("/proc/" + id + "/task/" + id + "/children") >> child;
  if (child <= 0) throw std::runtime_error("the run has no guard");
  return child;
}

// By the machine's clock a link is lost where the machine stands still for 0.1 s. Such a run tells
// nothing of palpate: it is run again, so many times at most.
inline constexpr int runs_by_the_clock = 10;
inline bool link_was_lost(const Ended& ended) { return has(ended.err, "the link is lost"); }

// A number of the last row of a stand's log, while it is written; above all heights without rows.
inline double last_in_log(const fs::path& log, const std::string& column) {
  const std::string text = read_file(log);
  const std::size_t end = text.rfind('\n');
  const std::size_t begin = end == std::string::npos ? end : text.rfind('\n', end - 1);
  if (begin == std::string::npos) return 1.0;
  const std::vector<std::string> names = split(text.substr(0, text.find('\n')), ',');
  const std::vector<std::string> cells = split(text.substr(begin + 1, end - begin - 1), ',');
  // From the right, for the bytes of the line may have commas.
  const auto from_right = names.end() - std::find(names.begin(), names.end(), column);
  return whole_number(*(cells.end() - from_right)).value_or(1.0);
}

class Played {
 public:
  explicit Played(const Session& session) {
    std::vector<std::string> words{session.link, "--clock", session.clock, "--log",
                                   folder_ / "log.csv"};
    const bool has_tissue = std::find(session.emulator.begin(), session.emulator.end(),
                                      "--tissue") != session.emulator.end();
    if (session.link == "mark10" && !has_tissue)
      words.insert(words.end(), {"--tissue", project_file("scenarios/emulator/stand_tissue.toml")});
    // The hand presses at a time of the emulator; by the machine's clock, where that may be before
    // the run begins, it rests.
    if (session.link != "mark10" && session.clock == "virtual")
      words.insert(words.end(), {"--hand", project_file("scenarios/emulator/arm_hand.toml")});
    words.insert(words.end(), session.emulator.begin(), session.emulator.end());
    LiveEmulator emulator(words);
    const std::string link =
        session.link == "mark10" ? "mark10:" + emulator.port() : emulator.arm_link();
    const std::string scenario = project_file("scenarios/" + session.scenario + ".toml");
    std::vector<std::string> call{"run", scenario,  "--device",    link,    "--out",
                                  "out", "--clock", session.clock, "--set", "output.figures=false"};
    const char* usual = session.link == "mark10" ? "-2 mm" : "130 mm";
    call.insert(call.end(), {"--surface", session.surface.empty() ? usual : session.surface});
    call.insert(call.end(), session.options.begin(), session.options.end());
    ended = palpate(folder_.path(), call);
    summary = emulator.end();
    if (summary.contains("summary")) summary = summary.at("summary");
    const fs::path result = folder_.path() / "out" / session.scenario;
    if (fs::exists(result / "force_indentation.csv")) {
      rows = Rows(record::read_csv((result / "force_indentation.csv").string()));
      findings = Rows(record::read_csv((result / "findings.csv").string()));
      health = nlohmann::json::parse(read_file(result / "device_health.json"));
    }
    log = Rows(record::read_csv((folder_ / "log.csv").string()));
  }

  [[nodiscard]] fs::path result(const std::string& scenario) const {
    return folder_.path() / "out" / scenario;
  }
  [[nodiscard]] const fs::path& folder() const { return folder_.path(); }

  // The time of the first fault, s of the emulator; NaN where none began.
  [[nodiscard]] double fault_time() const {
    for (std::size_t i = 0; i < log.size(); ++i)
      if (log.word(i, "kind") == "fault") return log.number(i, "time_s");
    return std::nan("");
  }

  Ended ended;
  nlohmann::json summary;
  nlohmann::json health;
  Rows rows;      // force_indentation.csv
  Rows findings;  // findings.csv
  Rows log;       // of the emulator

 private:
  TemporaryFolder folder_;
};

}  // namespace palpate::test
