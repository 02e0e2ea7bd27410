// A scenario file with its settings and its [sweep]: the cases that will be run.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/document.h"
#include "scenario/scenario.h"

namespace palpate::scenario {

// One case: every property filled in from its material.
struct Case {
  std::string name;  // the swept values, without folders, joined by `_`; without a sweep the
                     // scenario's name
  Scenario scenario;
  std::vector<std::pair<std::string, std::string>>
      swept;  // key and value, as written, without folders
};

// A file that a run read, to be hashed, and copied beside the echo so that it finds it.
struct InputFile {
  std::string name;  // as it is called in the echo
  std::string content;
};

struct Family {
  std::string name;    // the file's name without `.toml`: the result folder
  std::string folder;  // that relative paths start from
  std::string title;
  Node document;  // with the settings applied, without [sweep]
  Scenario base;  // as read, properties filled in only where they are given
  std::vector<std::pair<std::string, std::vector<Node>>> sweep;
  std::vector<Case> cases;
  std::vector<Problem> notes;
  std::vector<InputFile> inputs;
};

// Reads and checks a scenario. `settings` are `key=value` texts that go through the same checks.
// Throws InputError with every problem found.
[[nodiscard]] Family read(const std::string& path, const std::vector<std::string>& settings);

// The same from a text; `path` names it in messages, and its folder is where files are looked for.
[[nodiscard]] Family parse(const std::string& text, const std::string& path,
                           const std::vector<std::string>& settings);

// The resolved echo: TOML with every default spelled out, that reads back to the same run. `chosen`
// says for the cases that were run, by name, what stood for every `auto`.
using Chosen = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] std::string echo(const Family& family, const Chosen& chosen = {});

// The reference manual of all keys in markdown: docs/scenario.md.
[[nodiscard]] std::string manual();

// Fills in the properties that the scenario leaves to its materials. Adds to `problems`, at the
// document's places, and what was read to `inputs`. Where there are problems already, materials
// are looked up and no more, so that a mistake is told once.
void fill_in(Scenario& scenario, const Node& document, const std::string& folder,
             std::vector<InputFile>& inputs, std::vector<Problem>& problems);

// What single keys cannot know: steps that follow each other, methods that exclude each other,
// depths beyond the specimen. Adds to `problems`.
void check(const Scenario& scenario, const Node& document, std::vector<Problem>& problems);

// The place of the value at a dotted path, or of the nearest table around it.
[[nodiscard]] Place place_of(const Node& document, const std::string& path);

}  // namespace palpate::scenario
