// `palpate run`: runs scenarios one after the other, and the cases of each in parallel.
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/stop_scope.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "base/written.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "fit/case_fits.h"
#include "report/answer_lines.h"
#include "report/manifest.h"
#include "report/results.h"
#include "run/family.h"

namespace palpate::cli {
namespace {

void refuse_same_names(const std::vector<scenario::Family>& families) {
  std::set<std::string> names;
  for (const scenario::Family& family : families)
    if (!names.insert(family.name).second)
      throw InputError({family.document.place.file, 0, 0},
                       "has the same name as another scenario of this run, `" + family.name +
                           "`; rename one, or run them one by one with `--out`");
}

void say_warnings(const std::vector<record::CaseRecord>& records, const Talk& talk) {
  std::vector<report::NamedSentence> warnings;
  for (const record::CaseRecord& record : records)
    for (const std::string& warning : record.warnings)
      warnings.push_back({record.name, warning + "."});
  for (const std::string& line : report::said_once(warnings)) talk.say(line);
}

// A family with its scenes and its result folder, ready to run.
struct Prepared {
  const scenario::Family* family = nullptr;
  int workers = 1;
  std::vector<scene::Scene> scenes;
  std::unique_ptr<report::ResultFolder> folder;
  double seconds = 0.0;  // that the scenes took
};

// `It took 4.6 s: model and mesh 1.2 s, steps 3 s, figures and files 0.4 s.`
std::string time_sentence(double scenes, double steps, double files) {
  const auto text = [](double seconds) {
    return seconds < 60.0 ? rounded_text(seconds, 2) + " s" : duration_text(seconds);
  };
  return "It took " + text(scenes + steps + files) + ": model and mesh " + text(scenes) +
         ", steps " + text(steps) + ", figures and files " + text(files) + ".";
}

Prepared prepare(const scenario::Family& family, const Run& command, const Talk& talk) {
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  Prepared prepared;
  prepared.family = &family;
  prepared.workers =
      static_cast<int>(std::min(as_index(worker_count(command.jobs)), family.cases.size()));
  prepared.folder = std::make_unique<report::ResultFolder>(
      command.out, family, command.force ? Replace::any : Replace::incomplete,
      report::origin_of(family));
  const Stopwatch watch;
  prepared.scenes = run::build_all(family, prepared.workers);
  prepared.seconds = watch.seconds();
  return prepared;
}

// The event of a case that has ended: its derived quantities under the names of findings.csv, the
// error as a fraction (null where none is stated), and the sentences for people.
Talk::Details details_of(const std::string& scenario, const record::CaseRecord& record) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  Talk::Details details{{"scenario", scenario},
                        {"case", record.name},
                        {"outcome", record::outcome_word(record.outcome)},
                        {"reason", record.reason},
                        {"error", record.answer.stated_error.value_or(unknown)}};
  for (const record::Finding& finding : record.findings) {
    if (finding.name == "outcome") continue;
    if (const auto* word = std::get_if<std::string>(&finding.value))
      details.emplace_back(finding.name, *word);
    else if (const auto* number = std::get_if<double>(&finding.value))
      details.emplace_back(finding.name, *number);
  }
  details.emplace_back("sentences",
                       std::map<std::string, std::string>{{"model", record.answer.model},
                                                          {"error", record.answer.error},
                                                          {"neglected", record.answer.neglected}});
  return details;
}

struct Ran {
  std::size_t kept = 0;  // number of finished cases
  bool diverged = false;
  std::string missing = {};  // figures that were not drawn, for the last line
};

// Runs all cases and writes the result folder, unless an interrupt came before the first case
// ended.
Ran run_family(const Prepared& prepared, const Arguments& arguments, const Talk& talk) {
  const scenario::Family& family = *prepared.family;
  const std::vector<scene::Scene>& scenes = prepared.scenes;
  report::ResultFolder& folder = *prepared.folder;
  const std::string started = report::utc_now();
  folder.open();
  std::atomic<std::size_t> done{0};
  std::optional<ProgressLine> ticker(std::in_place, talk, [&](double seconds) {
    return (scenes.size() > 1 ? bar(done, scenes.size(), seconds) + ", " : "") + family.name;
  });
  std::mutex one_at_a_time;
  std::vector<std::vector<fit::NamedFit>> fits_of(scenes.size());
  const auto finished = [&](std::size_t i, const record::CaseRecord& record) {
    if (family.base.output.fits && record.outcome != record::Outcome::interrupted)
      fits_of[i] = fit::case_fits(scenes[i].scenario, record, fit::Residuals::correlated);
    folder.keep(i, record);
    const std::lock_guard lock(one_at_a_time);
    ++done;
    talk.event("case", details_of(family.name, record));
  };
  const Stopwatch running;
  const std::vector<record::CaseRecord> records = run::run_all(scenes, prepared.workers, finished);
  const double steps = running.seconds();
  ticker.reset();
  if (StopScope::stopped() && records.empty()) return {};

  Ran ran{.kept = records.size()};
  say_warnings(records, talk);
  for (const record::CaseRecord& record : records)
    if (record.outcome == record::Outcome::diverged) {
      ran.diverged = true;
      Talk::error(family.name + ", case " + record.name + ": " + record.reason +
                  "; last stable time " + rounded_text(record.last_stable_time) +
                  " s, everything up to it is kept");
    }
  std::vector<fit::NamedFit> fits;
  for (std::vector<fit::NamedFit>& one : fits_of)
    fits.insert(fits.end(), std::make_move_iterator(one.begin()),
                std::make_move_iterator(one.end()));
  const Stopwatch filing;
  ran.missing = warn_all(folder.finish(records, fits, {arguments.given, started}), talk);
  const double files = filing.seconds();
  for (const std::string& line : report::answer_lines(records)) talk.say(line);
  talk.say(time_sentence(prepared.seconds, steps, files));
  if (const std::string page = folder.path() + "/report.html"; std::filesystem::exists(page))
    talk.say("The page to look at is " + page + ".");
  const auto early = std::ranges::count_if(
      records, [](const auto& record) { return record.outcome != record::Outcome::completed; });
  talk.say(folder.path() + ": " + std::to_string(records.size()) + " of " +
           count_text(scenes.size(), "case") +
           (early == 0 ? "" : ", " + std::to_string(early) + " ended early") + ran.missing);
  talk.event("result", {{"scenario", family.name}, {"folder", folder.path()}});
  talk.next("open", folder.path());
  return ran;
}

// What a run would do, as far as the built scenes tell.
void say_plan(const Prepared& prepared, const Talk& talk) {
  std::string text = prepared.folder->path() + ": " + count_text(prepared.scenes.size(), "case") +
                     " would be computed and written here\n";
  for (const scene::Scene& scene : prepared.scenes) {
    const std::string model = scenario::traits(scene.scenario.solver.model).word;
    const scene::Forecast* forecast = scene.choice.taken();
    text += "  " + scene.name + ": " + model;
    if (forecast != nullptr) text += ", error " + error_text(forecast->error);
    if (scene.specimen) text += ", " + std::to_string(scene.specimen->network.nodes()) + " nodes";
    text += "\n";
    talk.event("planned", {{"scenario", prepared.family->name},
                           {"case", scene.name},
                           {"model", model},
                           {"folder", prepared.folder->path()}});
  }
  if (!talk.json()) print(text);
}

}  // namespace

int perform(const Run& command, const Arguments& arguments, const Talk& talk) {
  if (!command.device.link.empty()) return run_live(command, arguments, talk);
  std::vector<scenario::Family> families;
  std::vector<Problem> problems;
  for (const std::string& path : command.scenarios) {
    try {
      families.push_back(scenario::read(path, command.settings));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(problems);
  refuse_same_names(families);
  // All scenes are built before the first case runs, so that mistakes are reported first. Until
  // here a signal may end the program at once, because nothing has been written.
  std::vector<Prepared> all;
  for (const scenario::Family& family : families) all.push_back(prepare(family, command, talk));
  if (command.dry) {
    for (const Prepared& prepared : all) say_plan(prepared, talk);
    return exit_good;
  }
  const StopScope scope(listen_for_interrupts(exit_interrupted));
  Ran ran;
  for (const Prepared& prepared : all) {
    if (StopScope::stopped()) break;
    const auto [kept, diverged, missing] = [&] {
      try {
        return run_family(prepared, arguments, talk);
      } catch (const SystemError& error) {
        const std::string left = prepared.folder->kept();
        throw SystemError(error.what() +
                          (left.empty() ? "" : "; the finished cases are in " + left));
      }
    }();
    ran.kept += kept;
    ran.diverged = ran.diverged || diverged;
    ran.missing += missing;
  }
  if (StopScope::stopped()) {
    Talk::error(std::string("palpate: interrupted; ") +
                (ran.kept > 0 ? "finished cases are kept" + ran.missing : "nothing was written"));
    return exit_interrupted;
  }
  return ran.diverged ? exit_diverged : exit_good;
}

}  // namespace palpate::cli
