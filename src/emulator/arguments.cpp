// Parses the command line. This is the only file of the emulator that uses CLI11.
#include "emulator/arguments.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "commands/pages.h"
#include "emulator/arm_server.h"
#include "emulator/line_gauge.h"
#include "emulator/mark10_link.h"
#include "emulator/settings.h"

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

std::optional<double> lifetime_of(const Common& common) {
  if (common.lifetime.empty()) return {};
  return time_of("--for", common.lifetime);
}

void list_faults(const char* link, std::span<const FaultKind> kinds) {
  for (const FaultKind& kind : kinds) std::printf("%s\t%s\t%s\n", link, kind.name, kind.what);
}

struct Mark10Arguments {
  Common common = {};
  Mark10Run run = {};
  std::string stand = {};
  std::string tick = "20 ms";
  std::string latency = "0 ms";
  std::string jitter = "0 ms";
};

CLI::App* add_mark10(CLI::App& app, Mark10Arguments& given) {
  CLI::App* verb = app.add_subcommand("mark10", "a motorised stand with a gauge, on a pty");
  add_common(*verb, given.common);
  verb->add_option("--link", given.run.line.link, "symbolic link to the port");
  verb->add_option("--stand", given.stand, "TOML file of the tables [stand] and [gauge]");
  verb->add_option("--seed", given.run.settings.stand.seed, "of the gauge's noise");
  verb->add_option("--baud", given.run.line.baud, "rate of the line");
  verb->add_option("--tick", given.tick, "virtual clock: replies come at multiples of this time");
  verb->add_option("--latency", given.latency, "virtual clock: age of the readings in a reply");
  verb->add_option("--jitter", given.jitter, "virtual clock: largest random part of that age");
  return verb;
}

int start(Mark10Arguments& given) {
  Mark10Settings& settings = given.run.settings;
  if (!given.stand.empty()) read_stand(given.stand, settings.stand);
  if (given.common.tissue == "none")
    settings.stand.tissue.surface = -1.0;  // m, out of reach
  else if (!given.common.tissue.empty())
    settings.stand.tissue = read_tissue(given.common.tissue);
  if (!given.common.faults.empty())
    settings.faults = read_faults(given.common.faults, stand_faults());
  given.run.line.clock = clock_of(given.common);
  given.run.line.tick = step_of("--tick", given.tick);
  settings.latency = nanoseconds(time_of("--latency", given.latency));
  settings.jitter = nanoseconds(time_of("--jitter", given.jitter));
  if (settings.latency < 0 || settings.jitter < 0 ||
      settings.latency + settings.jitter >= given.run.line.tick)
    throw InputError({"--latency"},
                     "a reading must be younger than one tick; give shorter times of `--latency` "
                     "and `--jitter`, or a longer `--tick`");
  given.run.line.log = given.common.log;
  given.run.line.lifetime = lifetime_of(given.common);
  return run_mark10(given.run);
}

struct GaugeArguments {
  Common common = {};
  LineGaugeSettings settings = {};
  PtyRun run = {.baud = 9600};
  std::string file = {};
  std::string tick = "100 ms";
};

CLI::App* add_gauge(CLI::App& app, GaugeArguments& given) {
  CLI::App* verb =
      app.add_subcommand("gauge", "a gauge that sends lines, pressed by hand, on a pty");
  add_common(*verb, given.common);
  verb->add_option("--link", given.run.link, "symbolic link to the port");
  verb->add_option("--gauge", given.file, "TOML file of the tables [gauge] and [[waypoint]]");
  verb->add_option("--seed", given.settings.seed, "of the gauge's noise");
  verb->add_option("--baud", given.run.baud, "rate of the line");
  verb->add_option("--tick", given.tick, "virtual clock: replies come at multiples of this time");
  return verb;
}

int start(GaugeArguments& given) {
  LineGaugeSettings& settings = given.settings;
  if (!given.file.empty()) read_line_gauge(given.file, settings);
  if (given.common.tissue == "none")
    settings.tissue.surface = -1.0;  // m, out of reach
  else if (!given.common.tissue.empty())
    settings.tissue = read_tissue(given.common.tissue);
  if (!given.common.faults.empty())
    settings.faults = read_faults(given.common.faults, gauge_faults());
  given.run.clock = settings.clock = clock_of(given.common);
  given.run.tick = settings.tick = step_of("--tick", given.tick);
  settings.baud = given.run.baud;
  given.run.log = given.common.log;
  given.run.lifetime = lifetime_of(given.common);
  Log log(given.run.log, "travel_m,force_N");
  LineGauge gauge(settings, log);
  return PtyLoop<LineGauge>(given.run, gauge).go();
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
  if (!given.common.faults.empty())
    settings.faults = read_faults(given.common.faults, arm_faults());
  settings.clock = clock_of(given.common);
  settings.period = step_of("--period", given.period);
  if (given.service != "3.1" && given.service != "3.5")
    throw InputError({"--service"},
                     "there is no service `" + given.service + "`; write `3.1` or `3.5`");
  if (given.service == "3.1") settings.service = Service::v3_1;
  for (const int port : {given.run.port, given.run.events_port})
    if (port < 0 || port > 65535)
      throw InputError({"--port"}, "the number must lie between 0 and 65535; write 0 for any");
  given.run.log = given.common.log;
  given.run.lifetime = lifetime_of(given.common);
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

int program(int argc, const char* const* argv) {
  try {
    return parse_and_run(argc, argv);
  } catch (const InputError& refused) {
    std::fprintf(stderr, "palpate-emulator: %s\n", refused.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate-emulator: %s\n", error.what());
    return 1;
  }
}

}  // namespace emulator
