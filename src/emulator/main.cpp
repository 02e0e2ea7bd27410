// palpate-emulator: plays a test stand, a gauge or a haptic arm. Parses the command line, as the
// only file of the emulator that uses CLI11. Exit codes: 2 for refused arguments and input files, 1
// for any other error.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "commands/command.h"
#include "emulator/arm.h"
#include "emulator/files.h"
#include "emulator/line_gauge.h"
#include "emulator/serial_device.h"
#include "emulator/stand.h"

namespace emulator {
namespace {

struct Common {
  std::string tissue = {};
  std::string faults = {};
  std::string clock = "real";
  std::string log = {};
  std::string lifetime = {};
};

void add_common(CLI::App& verb, Common& common) {
  verb.add_option("--tissue", common.tissue, "TOML file of the tissue, or `none`");
  verb.add_option("--fault", common.faults, "TOML file of [[fault]] tables");
  verb.add_option("--clock", common.clock, "`real`, or `virtual`: time passes with traffic only");
  verb.add_option("--log", common.log, "CSV file of traffic, faults and the true state");
  verb.add_option("--for", common.lifetime, "ends after this real time, such as \"60 s\"");
}

Clock clock_of(const Common& common) {
  if (common.clock == "real") return Clock::real;
  if (common.clock == "virtual") return Clock::lockstep;
  throw InputError({"--clock"},
                   "there is no clock `" + common.clock + "`; write `real` or `virtual`");
}

// The time (s) that an option gives.
double time_of(const char* option, const std::string& text) {
  try {
    return palpate::parse_quantity(text, unit::s);
  } catch (const std::invalid_argument& error) {
    throw InputError({option}, error.what());
  }
}

Nanoseconds step_of(const char* option, const std::string& text) {
  const Nanoseconds step = nanoseconds(time_of(option, text));
  if (step <= 0) throw InputError({option}, "the time must be above 0 s; write `1 ms`");
  return step;
}

// Log and end of a run, of whatever device.
template <class Run>
void take_common(const Common& given, Run& run) {
  run.log = given.log;
  if (!given.lifetime.empty()) run.lifetime = time_of("--for", given.lifetime);
}

std::vector<Fault> faults_of(const Common& given, std::span<const FaultKind> kinds) {
  return given.faults.empty() ? std::vector<Fault>() : read_faults(given.faults, kinds);
}

void list_faults(const char* link, std::span<const FaultKind> kinds) {
  for (const FaultKind& kind : kinds) std::printf("%s\t%s\t%s\n", link, kind.name, kind.what);
}

// The arguments of a device on a serial line.
template <class Settings>
struct LineArguments {
  Common common = {};
  Settings settings = {};
  PtyRun run = {};
  std::string file = {};
  std::string tick = {};
};

template <class Settings>
CLI::App* add_line(CLI::App& app, const char* name, const char* what,
                   LineArguments<Settings>& given) {
  CLI::App* verb = app.add_subcommand(name, what);
  add_common(*verb, given.common);
  verb->add_option("--link", given.run.link, "symbolic link to the port");
  verb->add_option("--baud", given.run.baud, "rate of the line");
  verb->add_option("--tick", given.tick, "virtual clock: replies come at multiples of this time");
  return verb;
}

template <class Settings>
void take_line(LineArguments<Settings>& given, TissueSettings& tissue,
               std::span<const FaultKind> kinds) {
  Settings& settings = given.settings;
  if (given.common.tissue == "none")
    tissue.surface = -1.0;  // m, out of reach
  else if (!given.common.tissue.empty())
    tissue = read_tissue(given.common.tissue);
  settings.faults = faults_of(given.common, kinds);
  given.run.clock = settings.clock = clock_of(given.common);
  given.run.tick = settings.tick = step_of("--tick", given.tick);
  settings.baud = given.run.baud;
  take_common(given.common, given.run);
}

struct Mark10Arguments : LineArguments<Mark10Settings> {
  std::string latency = "0 ms";
  std::string jitter = "0 ms";
};

CLI::App* add_mark10(CLI::App& app, Mark10Arguments& given) {
  given.tick = "20 ms";
  CLI::App* verb = add_line(app, "mark10", "a motorised stand with a gauge, on a pty", given);
  verb->add_option("--stand", given.file, "TOML file of the tables [stand] and [gauge]");
  verb->add_option("--seed", given.settings.stand.seed, "of the gauge's noise");
  verb->add_option("--latency", given.latency, "virtual clock: age of the readings in a reply");
  verb->add_option("--jitter", given.jitter, "virtual clock: largest random part of that age");
  return verb;
}

int start(Mark10Arguments& given) {
  Mark10Settings& settings = given.settings;
  if (!given.file.empty()) read_stand(given.file, settings.stand);
  take_line(given, settings.stand.tissue, stand_faults());
  settings.latency = nanoseconds(time_of("--latency", given.latency));
  settings.jitter = nanoseconds(time_of("--jitter", given.jitter));
  if (settings.latency < 0 || settings.jitter < 0 ||
      settings.latency + settings.jitter >= settings.tick)
    throw InputError({"--latency"},
                     "a reading must be younger than one tick; give shorter times of `--latency` "
                     "and `--jitter`, or a longer `--tick`");
  Log log(given.run.log, "position_m,travel_m,velocity_m_s,depth_m,force_N");
  Mark10 mark10(settings, log);
  return run_on_pty(given.run, mark10);
}

using GaugeArguments = LineArguments<LineGaugeSettings>;

CLI::App* add_gauge(CLI::App& app, GaugeArguments& given) {
  given.run.baud = 9600;
  given.tick = "100 ms";
  CLI::App* verb =
      add_line(app, "gauge", "a gauge that sends lines, pressed by hand, on a pty", given);
  verb->add_option("--gauge", given.file, "TOML file of the tables [gauge] and [[waypoint]]");
  verb->add_option("--seed", given.settings.seed, "of the gauge's noise");
  return verb;
}

int start(GaugeArguments& given) {
  if (!given.file.empty()) read_line_gauge(given.file, given.settings);
  take_line(given, given.settings.tissue, gauge_faults());
  Log log(given.run.log, "travel_m,force_N");
  LineGauge gauge(given.settings, log);
  return run_on_pty(given.run, gauge);
}

struct ArmArguments {
  Common common = {};
  ArmRun run = {};
  std::string hand = {};
  std::string service = "3.5";
  std::string period = "1 ms";
};

CLI::App* add_inverse3(CLI::App& app, ArmArguments& given) {
  CLI::App* verb =
      app.add_subcommand("inverse3", "a haptic arm and the hand that holds it, on TCP");
  add_common(*verb, given.common);
  verb->add_option("--port", given.run.port, "of 127.0.0.1; 0: any free port");
  verb->add_option("--events-port", given.run.events_port, "of the events; 0: any free port");
  verb->add_option("--hand", given.hand, "TOML file of [hand], [[waypoint]] and [device]");
  verb->add_option("--service", given.service, "version of the service: `3.1` or `3.5`");
  verb->add_option("--period", given.period, "virtual clock: time that one client message takes");
  return verb;
}

int start(ArmArguments& given) {
  ArmSettings& settings = given.run.settings;
  if (!given.hand.empty()) read_hand(given.hand, settings);
  if (!given.common.tissue.empty() && given.common.tissue != "none")
    settings.tissue = read_tissue(given.common.tissue);
  settings.faults = faults_of(given.common, arm_faults());
  settings.clock = clock_of(given.common);
  settings.period = step_of("--period", given.period);
  if (given.service != "3.1" && given.service != "3.5")
    throw InputError({"--service"},
                     "there is no service `" + given.service + "`; write `3.1` or `3.5`");
  if (given.service == "3.1") settings.service = Service::v3_1;
  for (const int port : {given.run.port, given.run.events_port})
    if (port < 0 || port > 65535)
      throw InputError({"--port"}, "the number must lie between 0 and 65535; write 0 for any");
  take_common(given.common, given.run);
  return run_inverse3(given.run);
}

int parse_and_run(int argc, const char* const* argv) {
  CLI::App app{"Plays a test stand, a gauge or a haptic arm, with its own tissue and hand",
               "palpate-emulator"};
  Mark10Arguments mark10;
  const CLI::App* stand_verb = add_mark10(app, mark10);
  GaugeArguments gauge;
  const CLI::App* gauge_verb = add_gauge(app, gauge);
  ArmArguments arm;
  const CLI::App* arm_verb = add_inverse3(app, arm);
  const CLI::App* faults_verb = app.add_subcommand("faults", "lists the faults for --fault");
  app.require_subcommand(1);
  app.set_help_all_flag("--man", "prints the man page")->group("");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForAllHelp&) {
    std::fputs(palpate::commands::man_page(
                   {"palpate-emulator", 1, "a test stand and a haptic arm, played", "palpate"},
                   palpate::commands::describe(app), "")
                   .c_str(),
               stdout);
    return 0;
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    throw InputError(palpate::Place{}, std::string(error.what()) + "; see palpate-emulator --help");
  }
  if (faults_verb->parsed()) {
    list_faults("mark10", stand_faults());
    list_faults("gauge", gauge_faults());
    list_faults("inverse3", arm_faults());
    return 0;
  }
  if (arm_verb->parsed()) return start(arm);
  if (gauge_verb->parsed()) return start(gauge);
  return stand_verb->parsed() ? start(mark10) : 1;
}

}  // namespace
}  // namespace emulator

int main(int argc, char** argv) {
  try {
    return emulator::parse_and_run(argc, argv);
  } catch (const palpate::InputError& refused) {
    std::fprintf(stderr, "palpate-emulator: %s\n", refused.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate-emulator: %s\n", error.what());
    return 1;
  }
}
