// The command line as values: one struct a verb, one table for parsing, help and suggestions.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "record/measured.h"

namespace palpate::cli {

// How the program talks, whatever the verb.
struct Manner {
  bool quiet = false;
  bool json = false;
};

// `run --device`.
struct RunDevice {
  std::string link;  // empty: offline
  bool arm = false;
  bool realtime = false;
  bool traffic = false;
  std::string surface;     // a length; empty: felt, or assumed
  std::string most_force;  // a force; empty: the rules' own
  double seconds = 0.0;    // 0: until the programme is over
  std::string clock = "real";
};
struct Run {
  std::vector<std::string> scenarios;
  RunDevice device;
  std::string out = "out";
  std::vector<std::string> settings;
  int jobs = 0;  // 0: as many as there are cores
  bool force = false;
};
struct Explain {
  std::string subject;  // a scenario's path, or a key
  std::vector<std::string> settings;
};
// Which columns of a measured file are meant, and how they are written: --x, --x-unit, --skip ...
using DataOptions = record::DataLayout;

// Models of `fit` beyond the table of fit/model.h: they have options of their own.
inline constexpr std::array further_models{"hertz", "layer", "prony", "prony_creep"};

struct Fit {
  std::string data;
  DataOptions columns;
  std::string model;
  double x_origin = 0.0;
  std::string radius;         // of the sphere, `11 mm`: hertz and layer
  double poisson_ratio = -1;  // of the tissue; -1: not said
  std::string thickness;      // of the layer
  std::string base;           // of the layer: bonded or frictionless; empty: bonded
  int terms = 0;              // of prony; 0: not said
};
struct Compare {
  std::string got;
  std::string want;
  std::string tolerances;
};
struct Bless {
  std::vector<std::string> names;
  std::string reason;
};
struct Mesh {
  std::string subject;  // a surface, a ready mesh or a scenario, by its ending
  std::string unit;     // of a surface's or mesh's coordinates
  int nodes = 0;        // 0: as `edge` says
  std::string edge;     // empty: as fine as the surface's own triangles
  std::vector<std::string> out;
  std::vector<std::string> settings;
  bool force = false;
};
struct Reference {
  std::string scenario;
  std::vector<std::string> settings;
  int levels = 3;
  std::string out;  // a folder; empty: nothing is written
  bool force = false;
};
struct Bench {
  std::vector<std::string> scenarios;  // none: the paper's four models
  int frames = 1000;
};
struct Chart {
  std::string scenario;
  std::vector<std::string> settings;
  std::string out = "out";
  int repeats = 5;  // of every timing
  bool force = false;
};
struct Stability {
  std::string scenario;
  std::vector<std::string> settings;
  std::string out = "out";
  bool force = false;
};
struct Sweep {
  enum class Act { plan, run, status, retry, merge, slurm };
  Act act = Act::plan;
  std::string subject;  // of `plan` a scenario, of the others a plan's folder
  std::vector<std::string> settings;
  std::string out = "out";    // of `plan`: the plan is OUT/SCENARIO_sweep
  bool yes = false;           // more cases than the ceiling are meant
  bool curves = false;        // every case's curves are kept, too
  std::string shard = "1/1";  // I/N
  int jobs = 0;
  std::string lanes = "auto";     // or none, all: which cases share a loop
  int chunk = 50;                 // cases a task of the array
  std::string time;               // of a task, as Slurm writes it; empty: the cluster's own limit
  std::vector<std::string> show;  // columns that `merge` draws; none: the usual ones
  bool force = false;
};
struct Identify {
  std::string data;
  DataOptions columns{.compression = "auto"};
  std::string scenario;
  std::vector<std::string> unknowns;  // KEY=LOW..HIGH
  std::string noise = "constant";     // or relative
  std::vector<std::string> settings;
  std::string out = "out";
  bool force = false;
};
struct Export {
  std::string result;  // a result folder, or one of its CSV files
  std::string format;
  std::string out = ".";
  std::string case_name;
  bool force = false;
};
struct Device {
  enum class Act { probe, monitor };
  Act act = Act::probe;
  std::string link;
  double seconds = 5.0;  // of a monitor
};
struct Manual {};

using Verb = std::variant<Run, Explain, Fit, Compare, Bless, Mesh, Reference, Bench, Chart,
                          Stability, Sweep, Identify, Export, Device, Manual>;

struct Arguments {
  Manner manner;
  std::vector<std::string> given;  // for run.json
  Verb verb;
};

// A command line that is not one of ours; the text is a sentence with a remedy.
struct UsageError {
  std::string message;
};
// Text that was asked for by --help or --version.
struct Answer {
  std::string text;
};

[[nodiscard]] std::variant<Arguments, UsageError, Answer> parse(
    const std::vector<std::string>& arguments);

}  // namespace palpate::cli
