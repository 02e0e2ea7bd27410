// A plan is made in a folder beside its own, from copies that it will be run from, and renamed.
#include "study/sweep_plan.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <unordered_set>

#include <unistd.h>

#include "base/document_writer.h"
#include "base/files.h"
#include "base/text.h"
#include "record/csv.h"
#include "run/share_out.h"
#include "scene/scene.h"
#include "study/sweep_plan_file.h"
#include "study/sweep_row.h"

namespace palpate::study {
namespace {

namespace fs = std::filesystem;

// A case of the plan, as plan.csv has it.
struct PlannedCase {
  std::uint64_t id = 0;
  std::vector<std::string> words;
};

// Removes what was begun, unless it has been put in its place.
class Beside {
 public:
  explicit Beside(const std::string& place)
      : path_(place + ".partial-" + std::to_string(::getpid())) {
    std::error_code error;
    fs::remove_all(path_, error);
    fs::create_directories(fs::path(path_) / "inputs", error);
    if (error) throw SystemError(path_ + " cannot be made: " + error.message());
  }
  ~Beside() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;

  [[nodiscard]] std::string file(const std::string& name) const {
    return (fs::path(path_) / name).string();
  }
  void put(const std::string& place) {
    std::error_code error;
    fs::rename(path_, place, error);
    if (error) throw SystemError("`" + place + "` cannot be made: " + error.message());
    path_.clear();
  }

 private:
  std::string path_;
};

// The scenario with its settings applied, naming files as they are called beside it.
std::string portable(const scenario::Family& family) {
  Node document = family.document;
  scenario::use_copies(document, "");
  return "# A sweep's scenario, its settings applied, its files beside it.\n" +
         toml_document(document) + family.design.toml();
}

// `tissue.young_modulus` = 20 kPa, ...
std::string words_of(const scenario::Family& family, std::size_t index) {
  std::vector<std::string> words;
  for (const scenario::Setting& setting : family.design.settings(index))
    words.push_back("`" + setting.key + "` = " + setting.word);
  return joined(words, ", ");
}

[[noreturn]] void refuse_case(const scenario::Family& family, std::size_t index,
                              std::vector<Problem> problems) {
  problems.push_back({{family.document.place.file, 0, 0},
                      "case " + std::to_string(index + 1) + " of " +
                          std::to_string(family.design.count()) + " (" + words_of(family, index) +
                          ") cannot be made; mend it, or leave it out of `sweep`"});
  throw InputError(problems);
}

// Every case, made from the copies; where one cannot be, the original has the places to name.
class Maker {
 public:
  Maker(const scenario::Family& original, const scenario::Family& copy)
      : original_(original), copy_(copy), files_(hashed_inputs(copy)) {}

  [[nodiscard]] PlannedCase operator()(std::size_t index) const {
    PlannedCase planned;
    try {
      const scenario::Case one = scenario::make_case(copy_, index);
      planned.id = case_id(one, files_);
      for (const auto& [key, word] : one.swept) planned.words.push_back(word);
    } catch (const InputError& error) {
      try {
        (void)scenario::make_case(original_, index);
      } catch (const InputError& same) {
        refuse_case(original_, index, same.problems());
      }
      refuse_case(copy_, index, error.problems());
    }
    return planned;
  }

 private:
  const scenario::Family& original_;
  const scenario::Family& copy_;
  HashedNames files_;
};

void refuse_twins(const scenario::Family& family, const std::vector<std::uint64_t>& ids) {
  std::vector<std::uint32_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return ids[a] != ids[b] ? ids[a] < ids[b] : a < b;
  });
  for (std::size_t i = 0; i + 1 < order.size(); ++i)
    if (ids[order[i]] == ids[order[i + 1]])
      throw InputError({family.document.place.file, 0, 0},
                       "cases " + std::to_string(order[i] + 1) + " (" + words_of(family, order[i]) +
                           ") and " + std::to_string(order[i + 1] + 1) + " (" +
                           words_of(family, order[i + 1]) +
                           ") compute the very same; leave one out of `sweep`");
}

// Writes plan.csv; returns its hash.
std::string write_cases(const std::string& path, const scenario::Family& original,
                        const scenario::Family& copy, int workers) {
  constexpr std::size_t block = 4096;
  const std::size_t count = copy.design.count();
  const Maker make(original, copy);
  std::vector<std::uint64_t> ids;
  ids.reserve(count);
  using Kind = scenario::Design::Kind;
  const Kind kind = copy.design.kind();
  const bool sampled = kind == Kind::lhs || kind == Kind::sobol || kind == Kind::saltelli;
  std::unordered_set<std::uint64_t> seen;
  Sha256 hash;
  GrowingFile file(path);
  for (std::size_t first = 0; first < count; first += block) {
    std::vector<PlannedCase> planned(std::min(block, count - first));
    run::share_out(planned.size(), workers, [&](std::size_t i) { planned[i] = make(first + i); });
    record::Table table{{"number", "id"}, {}};
    for (const std::string& key : copy.design.keys()) table.columns.push_back(key);
    for (std::size_t i = 0; i < planned.size(); ++i) {
      if (sampled && !seen.insert(planned[i].id).second)
        planned[i].id = twin_id(planned[i].id, first + i + 1);
      std::vector<record::Cell> row{static_cast<double>(first + i + 1), id_text(planned[i].id)};
      for (std::string& word : planned[i].words) {
        std::replace(word.begin(), word.end(), '\n', ' ');  // a case is a line
        row.push_back(plan_cell(word));
      }
      table.rows.push_back(std::move(row));
      ids.push_back(planned[i].id);
    }
    std::string text = record::csv_text(table);
    if (first > 0) text.erase(0, text.find('\n') + 1);
    hash.add(text);
    file.append(text);
  }
  file.sync();
  refuse_twins(original, ids);
  return hash.digits();
}

void refuse_many(const scenario::Family& family, const std::string& forecast) {
  throw InputError({family.document.place.file, 0, 0},
                   "`sweep` makes " + std::to_string(family.design.count()) +
                       " cases, and more than " + std::to_string(sweep_ceiling) +
                       " are planned only on purpose; give `--yes` for that" +
                       (forecast.empty() ? "" : ", " + forecast));
}

// Time by the rungs' own estimates of the first, the middle and the last case.
std::string forecast(const scenario::Family& family, SweepOrder::Curves curves) {
  constexpr double bytes = 2400.0;  // of a row, about: measured in docs/sweeps.md
  const std::size_t count = family.design.count();
  double seconds = 0.0;
  try {
    for (const std::size_t i : {std::size_t{0}, count / 2, count - 1}) {
      const scene::Choice choice = scene::choose(scenario::make_case(family, i).scenario);
      if (choice.taken() == nullptr) return {};
      seconds += choice.taken()->seconds * static_cast<double>(count) / 3.0;
    }
  } catch (const InputError&) {  // a case that cannot be made is told of where all are
    return {};
  }
  return "about " + rounded_text(seconds, 2) + " s on one worker and " +
         rounded_text(bytes * static_cast<double>(count) / 1e6, 2) + " MB" +
         (curves == SweepOrder::Curves::kept ? " besides the curves" : "");
}

// `auto` may take rungs of which none reads a swept key.
void refuse_unread(const scenario::Family& family) {
  constexpr std::size_t most = 64;  // cases that are tried, spread evenly
  const std::size_t tries = std::min(family.design.count(), most);
  std::map<std::string, std::size_t> unread;
  for (std::size_t t = 0; t < tries; ++t) {
    const std::size_t i = tries == 1 ? 0 : t * (family.design.count() - 1) / (tries - 1);
    try {
      const scene::Choice choice = scene::choose(scenario::make_case(family, i).scenario);
      if (choice.given) return;  // the reader has looked already
      for (const std::string& key : scenario::unread_keys(family, i, choice.chosen.solver.model))
        ++unread[key];
    } catch (const InputError&) {  // told of where all cases are made
      return;
    }
  }
  for (const scenario::Setting& setting : family.design.settings(0))
    if (const auto found = unread.find(setting.key);
        found != unread.end() && found->second == tries)
      throw InputError(setting.place,
                       "`" + setting.key +
                           "` changes nothing: `model = \"auto\"` takes rungs that "
                           "do not read it in all of " +
                           std::to_string(tries) +
                           " cases tried; take it out of `[sweep]` or give `solver.model`");
}

}  // namespace

Planned plan_sweep(const SweepOrder& order) {
  const scenario::Family original = scenario::outline(order.scenario, order.settings);
  if (original.design.empty())
    throw InputError({order.scenario, 0, 0},
                     "has no `sweep`; give it one, or run it by `palpate run`");
  Planned planned{.folder = (fs::path(order.out) / (original.name + "_sweep")).string(),
                  .cases = original.design.count(),
                  .notes = original.notes,
                  .forecast = forecast(original, order.curves)};
  if (planned.cases > sweep_ceiling && order.ceiling == SweepOrder::Ceiling::holds)
    refuse_many(original, planned.forecast);
  refuse_unread(original);
  std::error_code ignored;
  const bool there = fs::exists(fs::path(planned.folder) / "plan.json");
  if (!there && fs::exists(planned.folder) && !fs::is_empty(planned.folder, ignored))
    throw InputError({planned.folder, 0, 0},
                     "is there already and is no plan of a sweep; give another `--out`");

  Beside beside(planned.folder);
  const std::string scenario = "inputs/scenario.toml";  // no other input is called so
  write_atomically(beside.file(scenario), portable(original));
  for (std::size_t i = 1; i < original.inputs.size(); ++i)
    write_atomically(beside.file("inputs/" + original.inputs[i].name), original.inputs[i].content);
  const scenario::Family copy = scenario::outline(beside.file(scenario), {});
  PlanFile file{.program = order.program,
                .name = original.name,
                .settings = order.settings,
                .curves = order.curves == SweepOrder::Curves::kept,
                .cases = planned.cases,
                .inputs = hashed_inputs(copy)};
  file.csv_hash = write_cases(beside.file("plan.csv"), original, copy, order.workers);
  const std::string text = plan_text(file);
  write_atomically(beside.file("plan.json"), text);
  if (there) {
    const std::string known = read_text((fs::path(planned.folder) / "plan.json").string());
    if (known != text)
      throw InputError({planned.folder, 0, 0},
                       "is the plan of another sweep, with another " +
                           differences(read_plan_file(known, planned.folder), file) +
                           "; plans do not change: give another `--out`, or remove that folder");
    planned.there_already = true;
    return planned;
  }
  fs::remove(planned.folder, ignored);  // an empty one
  beside.put(planned.folder);
  return planned;
}

SweepPlan read_plan(const std::string& folder, const std::string& program) {
  const std::string path = (fs::path(folder) / "plan.json").string();
  if (!fs::exists(path))
    throw InputError({folder, 0, 0}, "is no plan of a sweep; `palpate sweep plan` makes one");
  const std::string text = read_text(path);
  const PlanFile file = read_plan_file(text, path);
  if (file.program != program)
    throw InputError({path, 0, 0}, "was made by `" + file.program + "`, and this is `" + program +
                                       "`; use that one, or plan anew");
  const auto changed = [&](const std::string& name) {
    return InputError({(fs::path(folder) / name).string(), 0, 0},
                      "has changed since it was planned; put it back, or plan anew");
  };
  for (const auto& [name, hash] : file.inputs)
    if (sha256(read_text((fs::path(folder) / "inputs" / name).string())) != hash)
      throw changed("inputs/" + name);
  SweepPlan plan{.folder = folder,
                 .hash = sha256(text),
                 .program = program,
                 .curves = file.curves,
                 .family = {},
                 .ids = {}};
  plan.ids.reserve(file.cases);
  Sha256 hash;
  bool header = true;
  for_each_line((fs::path(folder) / "plan.csv").string(), [&](const FileLine& line) {
    hash.add(line.text);
    if (line.whole) hash.add("\n");
    std::size_t at = line.text.find(',') + 1;
    if (line.text.substr(at, 1) == "\"") ++at;  // an id of decimal digits alone
    if (!header) plan.ids.push_back(id_of(line.text.substr(at, 16)).value_or(0));
    header = false;
  });
  if (hash.digits() != file.csv_hash || plan.ids.size() != file.cases) throw changed("plan.csv");
  plan.family = scenario::outline((fs::path(folder) / "inputs/scenario.toml").string(), {});
  plan.family.name = file.name;
  if (plan.family.base.title.empty()) plan.family.title = file.name;
  return plan;
}

}  // namespace palpate::study
