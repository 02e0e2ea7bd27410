// A scenario file with its settings and its [sweep]: the cases that will be run.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/document.h"
#include "material/tissue_table.h"
#include "scenario/design.h"
#include "scenario/scenario.h"

namespace palpate::scenario {

// One case: every property filled in from its material.
struct Case {
  std::string name;  // the swept values, without folders, joined by `_`, or a number (Design);
                     // without a sweep the scenario's name
  Scenario scenario;
  std::vector<std::pair<std::string, std::string>>
      swept;                       // key and value, as written, without folders
  std::vector<std::string> files;  // names of the inputs that it reads, besides the scenario
};

// A file that a run read, to be hashed, and copied beside the echo so that it finds it.
struct InputFile {
  std::string name;  // as it is called in the echo
  std::string content;
};

// What was read for a family, once for all of its cases.
struct Library {
  std::map<std::string, material::Tissue> tissues;  // by their name in the scenario
  std::set<std::string> geometry;                   // paths of meshes and surfaces
};

struct Family {
  std::string name;    // the file's name without `.toml`: the result folder
  std::string folder;  // that relative paths start from
  std::string title;
  Node document;  // with the settings applied, without [sweep]
  Scenario base;  // as read, properties filled in only where they are given
  Design design;  // of its [sweep]
  std::vector<Case> cases;
  std::vector<Problem> notes;
  std::vector<InputFile> inputs;
  Library library;
};

inline constexpr std::size_t most_cases = 1000;  // that are made at once

// Reads and checks a scenario and makes every case. `settings` are `key=value` texts that go
// through the same checks. Throws InputError with every problem found.
[[nodiscard]] Family read(const std::string& path, const std::vector<std::string>& settings);

// The same from a text; `path` names it in messages, and its folder is where files are looked for.
[[nodiscard]] Family parse(const std::string& text, const std::string& path,
                           const std::vector<std::string>& settings);

// The same checks without the cases, of which there may be any number: `cases` stays empty. Tried
// are all cases of a small family; of a large one every value of every list, the ends of every
// range and a few hundred cases between, so that values that fail only together come up when
// make_case meets them.
[[nodiscard]] Family outline(const std::string& path, const std::vector<std::string>& settings);
[[nodiscard]] Family outline_text(const std::string& text, const std::string& path,
                                  const std::vector<std::string>& settings);

// Case i < design.count(). Reads no file that the family has read. Safe from several threads.
// Throws InputError with every problem of this case.
[[nodiscard]] Case make_case(const Family& family, std::size_t i);

// The swept keys of case i that have no effect once `model = "auto"` has become `chosen`.
[[nodiscard]] std::vector<std::string> unread_keys(const Family& family, std::size_t i,
                                                   Solver::Model chosen);

// The family with its case i alone; the others are not looked at.
[[nodiscard]] Family parse_case(const std::string& text, const std::string& path,
                                const std::vector<std::string>& settings, std::size_t i);

// Every value of a case that counts, as TOML: two cases with the same text are the same run, if the
// files that they read are the same.
[[nodiscard]] std::string spelled_out(const Case& one);

// The resolved echo: TOML with every default spelled out, that reads back to the same run. `chosen`
// says for the cases that were run, by name, what stood for every `auto`.
using Chosen = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] std::string echo(const Family& family, const Chosen& chosen = {});

// The reference manual of all keys in markdown: docs/scenario.md.
[[nodiscard]] std::string manual();

// What fill_in reads from.
struct Sources {
  struct ReadFile {
    InputFile file;
    Place place;  // of the key that names it
  };
  const std::string& folder;
  const Library& known;                // read before
  Library found = {};                  // read now
  std::vector<ReadFile> read = {};     // the files of `found`
  std::vector<std::string> used = {};  // names of all files that were asked for
};

// Fills in the properties that the scenario leaves to its materials. Adds to `problems`, at the
// document's places. Where there are problems already, materials are looked up and no more, so
// that a mistake is told once.
void fill_in(Scenario& scenario, const Node& document, Sources& sources,
             std::vector<Problem>& problems);

// What single keys cannot know: steps that follow each other, methods that exclude each other,
// depths beyond the specimen. Adds to `problems`.
void check(const Scenario& scenario, const Node& document, std::vector<Problem>& problems);

// The place of the value at a dotted path, or of the nearest table around it.
[[nodiscard]] Place place_of(const Node& document, const std::string& path);

}  // namespace palpate::scenario
