// The command line as values: one struct per verb.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/fields.h"
#include "base/units.h"
#include "commands/command.h"
#include "measured/measured.h"

namespace palpate::cli {

// Options of all verbs.
struct Manner {
  bool quiet = false;
  bool json = false;
  bool csv = false;  // CSV on a terminal too
  bool no_colour = false;
};

// Options of `run` with `--device`.
struct RunDevice {
  std::string link;  // empty: no device
  bool arm = false;
  bool realtime = false;
  bool traffic = false;
  bool expect = false;
  std::string surface;     // a length; empty: found by a press, or assumed
  std::string most_force;  // a force; empty: the default of the safety rules
  double seconds = 0.0;    // s; 0: until the loading history ends
  std::string clock = "real";
};
struct Run {
  static constexpr Word word{"run", "Run scenarios and write their results"};
  std::vector<std::string> scenarios;
  RunDevice device;
  std::string out = "out";
  std::vector<std::string> settings;
  int jobs = 0;  // 0: one per core
  bool force = false;
  bool dry = false;
};
struct Explain {
  static constexpr Word word{"explain", "What a scenario would compute, or what a key means"};
  std::string subject;  // a scenario's path, or a key
  std::vector<std::string> settings;
  std::string picture;    // file to write, .svg or .html; empty: none
  std::string case_name;  // of a sweep, which is explained at length; empty: the first
};
// The layout of a measured file: --x, --x-unit, --skip ...
using DataOptions = measured::DataLayout;

// Models of `fit` that are not in the table of fit/regression.h and have further options.
inline constexpr std::array further_models{
    "hertz",           "layer",       "jkr",         "dmt",
    "adhesive",        "prony",       "prony_creep", "modulus",
    "neo_hookean",     "ogden",       "yeoh",        "ogden3",
    "hertz_power_law", "hertz_solid", "spring_pot",  "spring_pot_creep",
    "fractional_zener"};

struct Fit {
  static constexpr Word word{"fit", "Fit a curve to two columns of text tables"};
  std::vector<std::string> data;  // with several, one row per curve and the population
  std::string out;                // folder of a population; empty: none
  bool force = false;
  DataOptions columns;
  bool csv = false;  // CSV also on a terminal
  std::string model;
  std::optional<double> x_origin;  // of time: none: where the step is
  std::string radius;              // of the tip, such as `11 mm`, for hertz and layer
  std::string tip;                 // of hertz: paraboloid (also empty), sphere, cone, pyramid3, ...
  std::string half_angle;          // of a cone or pyramid, in degrees
  std::string baseline;            // of hertz and layer: none, offset, tilt; empty: from the rows
  std::string baseline_from;       // the depths between which rows before contact are its baseline
  std::string baseline_to;
  std::string contact_point;  // where it is known; empty: fitted
  std::string time;           // column of the times, for the viscous contact models
  std::string atoms;          // of adhesive models: their distance at rest; empty: 0.3 nm
  std::string from;           // a depth below contact, or a share of the largest; empty: all
  std::string to;             // likewise
  double poisson_ratio = -1;  // of the tissue; -1: not given
  std::string thickness;      // of the layer
  std::string base;           // of the layer: bonded or frictionless; empty: bonded
  int terms = 0;              // of prony; 0: not given
  bool liquid = false;        // of prony: flows under load for ever
  // Of the ramp before a hold: its duration, in the unit of x; none: what the rows show.
  std::optional<double> ramp;
  std::string history;       // of prony: column of the strain, or of the stress in creep
  double history_power = 0;  // exponent of that column; 0: 1, or 3/2 of a depth under a force
  std::string height;        // of a specimen between platens: strain is length / height
  std::string diameter;      // of a round specimen: stress is force / area
  std::string area;          // of its cross-section, otherwise
  std::string platens;       // slippery (also empty) or bonded
  int cycle = 0;             // of several loadings, from 1; 0: not given
  bool toe = false;          // takes a toe off
  std::string loading;       // compression or tension; empty: by the signs
};
struct Data {
  static constexpr Word word{"data", "Say what is understood of a measured file"};
  std::string data;
  DataOptions columns{.compression = "auto"};
};
// What `compare` and `golden check` write for build servers.
struct CheckOptions {
  std::string junit;        // file of JUnit XML; empty: none
  std::string annotations;  // `github`; empty: none
  bool headed = false;      // the name of each check stands above its text
};
struct Compare {
  static constexpr Word word{"compare", "Compare results with expected ones"};
  std::string got;
  std::string want;
  std::string tolerances;
  std::string report;  // path of a page
  CheckOptions options;
};
struct Golden {
  static constexpr Word word{"golden",
                             "Store results of scenarios as baselines, and check that they stay"};
  enum class Act { add, check, list };
  Act act = Act::check;
  std::vector<std::string> subjects;  // scenarios or folders
  std::string reason;                 // why results are replaced; empty: none is kept
  CheckOptions options{.junit = {}, .annotations = {}, .headed = true};
  int jobs = 0;
  bool force = false;
};
struct Convert {
  static constexpr Word word{"convert", "Check and mesh a body, or write results, for other tools"};
  std::string subject;           // a surface, a mesh, a scenario or results, by its ending
  std::vector<std::string> out;  // files; of results a folder; empty: none, of results this folder
  bool force = false;
  // Of bodies.
  std::string unit;                    // of a surface's or mesh's coordinates
  int nodes = 0;                       // 0: given by `edge`
  std::string edge;                    // empty: the mean edge of the surface's triangles
  std::optional<double> repair_up_to;  // of a surface, as of a scenario's; empty: its default
  std::vector<std::string> settings;
  // Of results: a folder, or one of its CSV files.
  std::string format;
  std::string case_name;
};
struct Reference {
  static constexpr Word word{"reference",
                             "Forces by mesh refinement and extrapolation, with their error"};
  std::string scenario;
  std::vector<std::string> settings;
  std::string out;  // a folder; empty: no file is written
  bool force = false;
};
struct Chart {
  static constexpr Word word{"chart",
                             "Measure run time and error of every model, mesh and time step"};
  std::string scenario;  // with `frames` also empty: the paper's four models
  std::vector<std::string> settings;
  std::string out = "out";
  int repeats = 5;  // timings per variant
  bool force = false;
  int frames = 0;      // above 0: frames of 1 ms are timed instead
  std::string report;  // path of a page of these times
};
struct Stability {
  static constexpr Word word{"stability", "Measure where methods fail, and compare with theory"};
  std::string scenario;
  std::vector<std::string> settings;
  std::string out = "out";
  bool force = false;
};
struct Sweep {
  static constexpr Word word{"sweep", "Run many cases, on many workers and machines"};
  enum class Act { plan, run, status, retry, merge, parts, slurm };
  Act act = Act::plan;
  std::string subject;  // of `plan` a scenario, else the folder of a plan
  std::vector<std::string> settings;
  std::string out = "out";    // `plan` writes OUT/SCENARIO_sweep
  bool yes = false;           // allows any number of cases
  bool curves = false;        // keeps the curves of every case
  std::string shard = "1/1";  // I/N
  int jobs = 0;
  int chunk = 50;                 // cases per task of the array
  std::string time;               // limit per task, as Slurm writes it; empty: the cluster's
  std::vector<std::string> show;  // columns that `merge` draws; empty: the usual ones
  std::string reuse;              // folder of a plan; empty: none
  bool accept_failed = false;     // failed cases are no failure
  std::string done;               // file that says that the part is whole; empty: none
  int of = 1;                     // number of parts
  std::string program;            // as a shell takes it; empty: this one
  std::string prologue;           // file whose lines a task runs first; empty: none
  bool force = false;
};
struct Identify {
  static constexpr Word word{"identify", "Estimate tissue properties from a measured curve"};
  std::string data;
  DataOptions columns{.compression = "auto"};
  std::string scenario;
  std::vector<std::pair<std::string, std::string>> with;  // further pairs of data and scenario
  std::vector<std::string> unknowns;                      // KEY=LOW..HIGH
  std::vector<std::string> givens;                        // KEY=VALUE +- SD
  std::string noise = "constant";                         // or relative
  std::optional<double> x_origin;  // where the loading history begins, in the unit of x
  std::vector<std::string> settings;
  std::string out = "out";
  bool force = false;
};
struct Device {
  static constexpr Word word{"device", "Identify, monitor or stop a live device"};
  enum class Act { probe, monitor, stop };
  Act act = Act::probe;
  std::string link;
  double seconds = 5.0;  // of a monitor
};
struct New {
  static constexpr Word word{"new", "Write a commented scenario to begin with"};
  std::string kind;
  std::string file;  // empty: KIND.toml; `-`: stdout
  bool force = false;
};
struct Open {
  static constexpr Word word{"open", "Show the page of a result, or of all results in a folder"};
  std::string result;
};
struct Manual {
  static constexpr Word word{"manual", "Print a reference, in Markdown or as a man page"};
  std::string page = "keys";
  bool man = false;
};
struct Schema {
  static constexpr Word word{"schema", "Print the JSON Schema of scenarios, for editors"};
};
struct Completion {
  static constexpr Word word{"completion", "Print the completion script of a shell"};
  std::string shell;
};

// Every verb. It needs `word`, add_options() in arguments.cpp and perform() in verbs.h to compile.
using Verb = std::variant<New, Explain, Run, Sweep, Compare, Golden, Data, Fit, Identify, Device,
                          Chart, Stability, Reference, Convert, Open, Manual, Schema, Completion>;

struct Arguments {
  Manner manner;
  std::vector<std::string> given;  // for run.json
  Verb verb;
};

// An invalid command line; the text is a sentence with a remedy.
struct UsageError {
  std::string message;
};
// The text for --help or --version, or for no word at all.
struct Answer {
  std::string text;
};

// The SI value of an option's text, of any sign or above 0. Throws InputError with the option's
// name; `or_else` ends the sentence.
[[nodiscard]] double quantity_of(const std::string& option, const std::string& text,
                                 const Unit& unit, const std::string& or_else = "");
[[nodiscard]] double positive_of(const std::string& option, const std::string& text,
                                 const Unit& unit);

// The number of workers for `--jobs`; 0: one per core.
[[nodiscard]] int worker_count(int jobs);

// The table of all verbs and options, for pages and shells.
[[nodiscard]] commands::Command described();

[[nodiscard]] std::variant<Arguments, UsageError, Answer> parse(
    const std::vector<std::string>& arguments);

}  // namespace palpate::cli
