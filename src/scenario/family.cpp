// From a TOML text to cases.
#include "scenario/family.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/field_reader.h"
#include "base/files.h"
#include "base/text.h"

namespace palpate::scenario {
namespace {

// A case as far as it could be made.
struct Made {
  Case one;
  Scenario as_read;  // before materials filled it in
  Reading reading;
};

Made make(const Family& family, std::size_t i, Sources& sources) {
  Made made;
  Node document = family.document;
  const std::vector<Setting> settings = family.design.settings(i);
  for (const Setting& setting : settings) {
    set_value(document, setting.key, setting.value, setting.place);
    made.one.swept.emplace_back(setting.key, setting.word);
  }
  made.one.name = settings.empty() ? family.name : family.design.case_name(i, settings);
  Scenario& scenario = made.one.scenario;
  made.reading = read_fields(document, [&](FieldVisitor& visitor) { fields(visitor, scenario); });
  made.as_read = scenario;
  std::vector<Problem>& problems = made.reading.problems;
  fill_in(scenario, document, sources, problems);
  if (problems.empty()) check(scenario, document, problems);
  made.one.files = sources.used;
  return made;
}

// Keeps the first of problems that every case repeats.
void add_new(std::vector<Problem>& all, const std::vector<Problem>& more) {
  for (const Problem& problem : more) {
    const bool known = std::any_of(all.begin(), all.end(), [&](const Problem& other) {
      return other.text() == problem.text();
    });
    if (!known) all.push_back(problem);
  }
}

// The first input is the scenario itself, of which the results hold the echo, `scenario.toml`.
void remember_input(std::vector<InputFile>& inputs, const Sources::ReadFile& read,
                    std::vector<Problem>& problems) {
  const InputFile& added = read.file;
  if (added.name == "scenario.toml")
    return add_new(problems, {{read.place, "`" + added.name +
                                               "` is the name of the echo among the results; "
                                               "rename the file"}});
  for (std::size_t i = 1; i < inputs.size(); ++i) {
    if (inputs[i].name != added.name) continue;
    if (inputs[i].content == added.content) return;
    return add_new(problems,
                   {{read.place, "two different files are called `" + added.name +
                                     "`, and a result folder holds a copy of each; rename one"}});
  }
  inputs.push_back(added);
}

// Makes cases of a family one after the other, and gathers what they read and what is wrong.
class Trial {
 public:
  explicit Trial(Family& family) : family_(family) {}

  Case make(std::size_t i) {
    Sources sources{family_.folder, family_.library};
    Made made = scenario::make(family_, i, sources);
    if (i == 0 || !begun_) family_.base = made.as_read;
    begun_ = true;
    add_new(family_.notes, made.reading.notes);
    add_new(problems_, made.reading.problems);
    family_.library.tissues.merge(sources.found.tissues);
    family_.library.geometry.merge(sources.found.geometry);
    for (const Sources::ReadFile& read : sources.read)
      remember_input(family_.inputs, read, problems_);
    return made.one;
  }

  [[nodiscard]] std::vector<Problem>& problems() { return problems_; }

  void finish() {
    family_.title = family_.base.title.empty() ? family_.name : family_.base.title;
    sort_by_place(problems_);
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  Family& family_;
  bool begun_ = false;
  std::vector<Problem> problems_;
};

void check_case_names(const Family& family, const Place& sweep_place,
                      std::vector<Problem>& problems) {
  std::vector<std::string> names;
  for (const Case& one : family.cases) names.push_back(one.name);
  for (const auto& [name, factor] : family.base.output.display_scale) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const auto near = nearest(name, names);
    add_new(problems,
            {{place_of(family.document, "output.display_scale." + name),
              "`display_scale` names no case `" + name + "`" +
                  (near ? "; did you mean `" + *near + "`?" : "; cases: " + joined(names, ", "))}});
  }
  const std::set<std::string> different(names.begin(), names.end());
  if (different.size() != names.size())
    problems.push_back(
        {sweep_place, "two cases of `sweep` have the same name; give each value once"});
}

// A family with its design and no cases yet, and where its [sweep] stands.
struct Opened {
  Family family;
  Place sweep;
};

Opened open(const std::string& text, const std::string& path,
            const std::vector<std::string>& settings) {
  Opened opened;
  Family& family = opened.family;
  const std::filesystem::path file(path);
  family.name = file.stem().string();
  family.folder = file.parent_path().string();
  family.document = parse_toml(text, path);
  for (const std::string& setting : settings) {
    const auto [key, value] = parse_assignment(setting);
    set_value(family.document, key, value, value.place);
  }
  family.inputs.push_back({file.filename().string(), text});
  opened.sweep = place_of(family.document, "sweep");
  family.design = take_design(family.document);
  return opened;
}

}  // namespace

Place place_of(const Node& document, const std::string& path) {
  const Node* node = &document;
  Place place = document.place;
  for (const std::string& word : split(path, '.')) {
    const Node* next = nullptr;
    if (node->kind == Node::Kind::array) {
      const auto number = whole_number(word);
      if (number && *number >= 1 && *number <= static_cast<double>(node->items.size()))
        next = &node->items[static_cast<std::size_t>(*number) - 1];
    } else if (const Member* member = node->find(word)) {
      next = &member->value;
    }
    if (next == nullptr) return place;
    node = next;
    place = node->place;
  }
  return place;
}

Family parse(const std::string& text, const std::string& path,
             const std::vector<std::string>& settings) {
  Opened opened = open(text, path, settings);
  Family& family = opened.family;
  const std::size_t count = family.design.count();
  if (count > most_cases)
    throw InputError(opened.sweep, "`sweep` makes " + std::to_string(count) +
                                       " cases, and more than " + std::to_string(most_cases) +
                                       " are planned first: `palpate sweep plan " + path + "`");
  Trial trial(family);
  for (std::size_t i = 0; i < count; ++i) family.cases.push_back(trial.make(i));
  if (trial.problems().empty()) check_case_names(family, opened.sweep, trial.problems());
  trial.finish();
  return std::move(family);
}

Family read(const std::string& path, const std::vector<std::string>& settings) {
  return parse(read_text(path), path, settings);
}

Family parse_case(const std::string& text, const std::string& path,
                  const std::vector<std::string>& settings, std::size_t i) {
  Family family = open(text, path, settings).family;
  family.design = family.design.only(i);
  Trial trial(family);
  family.cases = {trial.make(0)};
  trial.finish();
  return family;
}

Family outline_text(const std::string& text, const std::string& path,
                    const std::vector<std::string>& settings) {
  Family family = open(text, path, settings).family;
  Trial trial(family);
  const std::size_t count = family.design.count();
  const std::size_t tried = std::min(count, most_cases);
  for (std::size_t k = 0; k < tried; ++k) (void)trial.make(k * (count / tried));
  trial.finish();
  return family;
}

Family outline(const std::string& path, const std::vector<std::string>& settings) {
  return outline_text(read_text(path), path, settings);
}

Case make_case(const Family& family, std::size_t i) {
  Sources sources{family.folder, family.library};
  Made made = make(family, i, sources);
  if (!made.reading.problems.empty()) throw InputError(made.reading.problems);
  return std::move(made.one);
}

}  // namespace palpate::scenario
