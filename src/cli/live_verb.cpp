// `palpate run --device`: one case against a live device or its recording.
#include <csignal>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "fit/case_fits.h"
#include "report/machine.h"
#include "report/results.h"
#include "run/family.h"
#include "run/live.h"
#include "run/live_guide.h"

namespace palpate::cli {
namespace {

// A quantity of an option. Throws InputError that names it.
double quantity(const std::string& option, const std::string& text, const Unit& unit) {
  try {
    return parse_quantity(text, unit);
  } catch (const std::exception& error) {
    throw InputError({option, 0, 0}, error.what());
  }
}

run::LiveOptions options_of(const Run& command) {
  run::LiveOptions options;
  options.link = command.device.link;
  if (command.device.arm) options.act = run::LiveOptions::Act::command;
  if (command.device.realtime) options.priority = run::LiveOptions::Priority::realtime;
  if (command.device.traffic) options.traffic = run::LiveOptions::Traffic::kept;
  if (command.device.clock == "virtual") options.clock = device::Clock::Kind::stepped;
  if (!command.device.surface.empty())
    options.surface = quantity("--surface", command.device.surface, unit::mm);
  if (!command.device.most_force.empty()) {
    options.most_force = quantity("--max-force", command.device.most_force, unit::N);
    if (!(*options.most_force > 0.0))
      throw InputError({"--max-force", 0, 0}, "wants a force above 0; write it as `2 N`");
  }
  if (command.device.seconds > 0.0) options.longest = command.device.seconds;
  return options;
}

int code_of(run::LiveEnd::Why why) {
  switch (why) {
    case run::LiveEnd::Why::interrupted: return exit_interrupted;
    case run::LiveEnd::Why::link: return exit_device;
    case run::LiveEnd::Why::model: return exit_diverged;
    case run::LiveEnd::Why::done:
    case run::LiveEnd::Why::too_long: break;
  }
  return exit_good;
}

}  // namespace

int run_live(const Run& command, const Arguments& arguments, const Talk& talk) {
  if (command.scenarios.size() != 1)
    throw InputError({"--device", 0, 0},
                     "wants one scenario, for a device runs one case; give them one by one");
  const std::string& file = command.scenarios.front();
  const scenario::Family family = scenario::read(file, command.settings);
  if (family.cases.size() != 1)
    throw InputError({file, 0, 0}, "has " + std::to_string(family.cases.size()) +
                                       " cases, and a device runs one; leave `[sweep]` and "
                                       "`[[case]]` out, or choose one by `--set`");
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  const run::LiveOptions options = options_of(command);
  report::ResultFolder folder(command.out, family, command.force);
  for (const std::string& rows : folder.rows_left_beside())
    talk.say("note: " + rows +
             " has the rows of a run that was killed, or that still goes on; nothing touches it, "
             "`--device replay:` plays it, remove its folder when it is of no use");
  const scene::Scene scene = scene::build(family.cases.front(), family);
  run::refuse_beyond_device(scene, file, options);
  // Before the link, whose own handlers come on top of these.
  const std::atomic<bool>& stop_requested = listen_for_interrupts(exit_interrupted);
  run::Live live(scene, options);
  for (const std::string& sentence : live.plan(file)) talk.say(sentence);
  const bool recording = options.link.starts_with("replay:");
  if (!command.device.arm && !recording) {
    talk.say("nothing was moved and no force was sent; give `--arm` to run this");
    return exit_good;
  }
  const std::string started = report::utc_now();
  // A file that may not grow is an error to be told of, as a full disk is.
  std::signal(SIGXFSZ, SIG_IGN);
  folder.open();
  const run::Live::Output output{
      .on_step =
          [&](int step) {
            talk.say("step " + std::to_string(step) + ": " +
                     run::guidance(scene.scenario.steps[static_cast<std::size_t>(step - 1)]));
          },
      .on_warning = [&](const std::string& sentence) { talk.warn(sentence); },
      .rows_file = folder.growing("force_indentation.csv"),
      .traffic_file = command.device.traffic ? folder.growing("traffic.csv") : std::string()};
  run::Live::Result result = live.go(stop_requested, output);
  if (result.rows_are_written) folder.take_grown("force_indentation.csv");
  if (command.device.traffic) folder.take_grown("traffic.csv");
  for (const std::string& warning : result.warnings) talk.warn(warning);
  for (const std::string& remark : result.record.remarks)
    talk.say(result.record.name + ": " + remark + ".");
  const std::string rows = std::to_string(result.record.contact.size()) + " rows";
  const int code = code_of(result.end.why);
  const std::string ended = "palpate: " + options.link + ": " + result.end.sentence;
  try {
    folder.keep(0, result.record);
    std::vector<fit::NamedFit> fits;
    if (family.base.output.fits && !result.record.contact.empty())
      fits = fit::case_fits(scene.scenario, result.record);
    for (const std::string& warning :
         folder.finish({result.record}, fits, {arguments.given, started}))
      talk.warn(warning);
  } catch (const SystemError& error) {
    if (code != exit_good) Talk::error(ended);
    throw SystemError(std::string(error.what()) + "; the rows that it took are in " +
                      output.rows_file);
  }
  talk.say(folder.path() + ": " + rows);
  talk.event("result", {{"scenario", family.name},
                        {"folder", folder.path()},
                        {"outcome", record::outcome_word(result.record.outcome)},
                        {"reason", result.record.reason}});
  if (code != exit_good) Talk::error(ended + "; " + rows + " are kept");
  return code;
}

}  // namespace palpate::cli
