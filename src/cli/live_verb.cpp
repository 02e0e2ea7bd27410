// `palpate run --device`: runs one case with a live device or a recording.
#include <csignal>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/stop_scope.h"
#include "base/units.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "device/link.h"
#include "fit/case_fits.h"
#include "live/live.h"
#include "report/answer_lines.h"
#include "report/manifest.h"
#include "report/results.h"
#include "run/choose.h"
#include "run/family.h"
#include "run/refined_mesh.h"

namespace palpate::cli {
namespace {

live::LiveOptions options_of(const Run& command) {
  live::LiveOptions options;
  options.link = command.device.link;
  if (command.device.arm) options.act = live::LiveOptions::Act::command;
  if (command.device.realtime) options.priority = live::LiveOptions::Priority::realtime;
  if (command.device.traffic) options.traffic = live::LiveOptions::Traffic::kept;
  if (command.device.clock == "virtual") options.clock = device::Clock::Kind::stepped;
  if (!command.device.surface.empty())
    options.surface = quantity_of("--surface", command.device.surface, unit::mm);
  if (!command.device.most_force.empty())
    options.most_force = positive_of("--max-force", command.device.most_force, unit::N);
  if (command.device.seconds > 0.0) options.longest = command.device.seconds;
  return options;
}

int code_of(live::LiveEnd::Why why) {
  switch (why) {
    case live::LiveEnd::Why::interrupted: return exit_interrupted;
    case live::LiveEnd::Why::link: return exit_device;
    case live::LiveEnd::Why::model: return exit_diverged;
    case live::LiveEnd::Why::done:
    case live::LiveEnd::Why::too_long: break;
  }
  return exit_good;
}

// The scenario with the steps that the stand carried out, for `palpate identify`.
std::string as_moved_text(scenario::Family family, std::vector<scenario::Step> steps) {
  family.base.steps = family.cases.front().scenario.steps = std::move(steps);
  return "# The loading history as the stand carried it out, read from its displacement: for "
         "`palpate identify`, with\n# `step.1.time`, the moment at which it set off, among the "
         "unknowns.\n" +
         scenario::echo(family);
}

}  // namespace

int run_live(const Run& command, const Arguments& arguments, const Talk& talk) {
  if (command.scenarios.size() != 1)
    throw InputError({"--device", 0, 0},
                     "wants one scenario, because a device runs one case; give them one by one");
  const std::string& file = command.scenarios.front();
  const scenario::Family family = scenario::read(file, command.settings);
  if (family.cases.size() != 1)
    throw InputError({file, 0, 0}, "has " + std::to_string(family.cases.size()) +
                                       " cases, and a device runs one; leave `[sweep]` and "
                                       "`[[case]]` out, or choose one by `--set`");
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  const live::LiveOptions options = options_of(command);
  report::ResultFolder folder(command.out, family,
                              command.force ? Replace::any : Replace::incomplete);
  for (const std::string& rows : folder.rows_left_beside())
    talk.say("note: " + rows +
             " contains the rows of a run that was killed or is still running; it is left as it "
             "is, `--device replay:` plays it; remove its folder when you no longer need it");
  scene::SpecimenShapes shapes;
  const scenario::Case& one = family.cases.front();
  const scene::Scene scene =
      run::build_scene(one, family, shapes, run::choose(one, shapes, run::Models::quick));
  live::refuse_beyond_device(scene, file, options);
  // Installed before the link, whose signal handlers are added to these. A reader of the messages
  // that goes away, and a closed terminal, must not end the run where it is.
  std::signal(SIGPIPE, SIG_IGN);
  const std::atomic<bool>& stop_requested = listen_for_interrupts(exit_interrupted, {SIGHUP});
  const std::unique_ptr<live::Live> set_up = [&] {
    const StopScope scope(stop_requested);
    auto made = std::make_unique<live::Live>(scene, options);
    if (command.device.expect && !made->measures_force())
      throw InputError({"--expect", 0, 0}, "wants a device that measures force, and `" +
                                               options.link + "` does not; leave the option out");
    for (const std::string& sentence : made->plan(file)) talk.say(sentence);
    return made;
  }();
  live::Live& live = *set_up;
  if (!command.device.arm && !device::only_reads(device::parse_link(options.link))) {
    talk.say("nothing was moved and no force was sent; give `--arm` to run this");
    return exit_good;
  }
  const std::string started = report::utc_now();
  folder.open();
  const live::Live::Output output{
      .say = [&](const std::string& sentence) { talk.say(sentence); },
      .on_warning = [&](const std::string& sentence) { talk.warn(sentence); },
      .rows_file = folder.growing(live.rows_name()),
      .traffic_file = command.device.traffic ? folder.growing("traffic.csv") : std::string()};
  live::Live::Result result = live.go(stop_requested, output);
  if (auto steps = live::as_moved(result.record, scene.scenario.steps);
      steps && options.link.starts_with("mark10:"))
    result.record.attached.emplace_back("as_moved.toml", as_moved_text(family, std::move(*steps)));
  if (result.rows_are_written) folder.take_grown(live.rows_name());
  if (command.device.traffic) folder.take_grown("traffic.csv");
  for (const std::string& warning : result.warnings) talk.warn(warning);
  for (const std::string& warning : result.record.warnings)
    talk.say(result.record.name + ": " + warning + ".");
  const std::string rows = std::to_string(result.rows) + " rows";
  const int code = code_of(result.end.why);
  if (result.verdict) result.record.answer.verdict = live::verdict_sentence(*result.verdict);
  const std::string ended = "palpate: " + options.link + ": " + result.end.sentence;
  std::string missing;
  try {
    folder.keep(0, result.record);
    std::vector<fit::NamedFit> fits;
    if (family.base.output.fits && !result.record.contact.empty())
      fits = fit::case_fits(scene.scenario, result.record, fit::Residuals::correlated);
    missing = warn_all(folder.finish({result.record}, fits, {arguments.given, started}), talk);
  } catch (const SystemError& error) {
    if (code != exit_good) Talk::error(ended);
    throw SystemError(std::string(error.what()) + "; the rows written before are in " +
                      output.rows_file);
  }
  if (!result.record.contact.empty())
    for (const std::string& line : report::answer_lines({result.record})) talk.say(line);
  talk.say(folder.path() + ": " + rows + missing);
  talk.event("result", {{"scenario", family.name},
                        {"folder", folder.path()},
                        {"outcome", record::outcome_word(result.record.outcome)},
                        {"reason", result.record.reason}});
  talk.next("open", folder.path());
  if (code != exit_good) Talk::error(ended + "; " + rows + " are kept");
  if (!result.verdict) return code;
  const std::string verdict = result.record.name + ": " + result.record.answer.verdict;
  const bool agrees = result.verdict->outcome == live::Verdict::Outcome::agrees;
  if (code != exit_good || !command.device.expect || agrees) {
    talk.say(verdict);
    return code;
  }
  Talk::error(verdict);
  return exit_different;
}

}  // namespace palpate::cli
