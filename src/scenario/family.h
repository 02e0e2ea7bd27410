// A scenario file with its settings and its [sweep]: the cases that will be run.
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/document.h"
#include "base/error.h"
#include "base/files.h"
#include "material/tissue_table.h"
#include "scenario/design.h"
#include "scenario/scenario.h"

namespace palpate::scenario {

// The materials that a scenario names.
struct Materials {
  material::Tissue tissue;
  std::vector<material::Tissue> regions;   // in the order of the scenario
  std::optional<material::Tissue> finger;  // if it matters; of a rigid finger only the density does
};

struct Case {
  std::string name;  // the swept values, without folders, joined by `_`, or a number (Design);
                     // without a sweep the scenario's name
  Scenario scenario;
  Materials materials;
  std::vector<std::pair<std::string, std::string>>
      swept;                                   // key and value, as written, without folders
  std::vector<std::string> files;              // names of the input files besides the scenario
  std::string folder;                          // of relative paths
  std::optional<Solver::Model> at_least = {};  // of Family
};

// Poisson's ratio of the tissue.
[[nodiscard]] inline double poisson_ratio(const Case& one) {
  return one.scenario.tissue.poisson_ratio.value_or(one.materials.tissue.poisson_ratio.value);
}

// A file that a run has read. It is hashed, and copied beside the echo, which refers to the copy.
struct InputFile {
  std::string name;  // in the echo
  std::string content;
};

[[nodiscard]] std::vector<HashedFile> hashed(const std::vector<InputFile>& files);

// Files read for a family, once for all of its cases.
struct Library {
  std::map<std::string, material::Tissue> tissues;  // by their names in the scenario
  std::set<std::string> geometry;                   // paths of meshes and surfaces
};

struct Family {
  std::string name;    // the file's name without `.toml`: the name of the result folder
  std::string folder;  // of relative paths
  std::string title;
  Node document;  // with the settings applied, without [sweep]
  Scenario base;  // the first case, as read
  Design design;  // of [sweep]
  std::vector<Case> cases;
  // Where `auto` takes a cheaper model for a case, it takes this one: run::one_model().
  std::optional<Solver::Model> at_least = {};
  std::vector<Problem> notes;
  std::vector<InputFile> inputs;
  Library library;
};

inline constexpr std::size_t most_cases = 1000;  // of a family whose cases are all made

// Reads and checks a scenario and makes all cases. `settings` are `key=value` texts, checked in the
// same way. Throws InputError with all problems found.
[[nodiscard]] Family read(const std::string& path, const std::vector<std::string>& settings);

// The same for a text; `path` names it in messages, and its folder is that of relative paths.
[[nodiscard]] Family parse(const std::string& text, const std::string& path,
                           const std::vector<std::string>& settings);

// The same checks for any number of cases, which are not kept: `cases` stays empty. Of a small
// family all cases are checked; of a large one every value of every list, both ends of every range
// and a few hundred cases in between. Values that are only wrong together may thus be found by
// make_case only.
[[nodiscard]] Family outline(const std::string& path, const std::vector<std::string>& settings);
[[nodiscard]] Family outline_text(const std::string& text, const std::string& path,
                                  const std::vector<std::string>& settings);

// The same with checks of the first case only: of a plan, which was checked when it was made.
[[nodiscard]] Family outline_planned(const std::string& path);

// Makes case i < design.count(). Reads no file that the family has read already. Thread-safe.
// Throws InputError with all problems of this case.
[[nodiscard]] Case make_case(const Family& family, std::size_t i);

// The case of that name, which is there.
[[nodiscard]] const Case& case_named(const Family& family, const std::string& name);

// The swept keys of case i that have no effect if `model = "auto"` has chosen `chosen`.
[[nodiscard]] std::vector<std::string> unread_keys(const Family& family, std::size_t i,
                                                   Solver::Model chosen);

// Whether Poisson's ratio affects the contact only, and the text that says so.
[[nodiscard]] bool poisson_in_contact_only(const Scenario& scenario);
extern const char* const poisson_in_contact_only_text;

// The family with case i as its only case; the other cases are not checked.
[[nodiscard]] Family parse_case(const std::string& text, const std::string& path,
                                const std::vector<std::string>& settings, std::size_t i);

// All values of a case that have an effect, those of its materials included, as TOML: cases with
// the same text (and the same input files) are the same run.
[[nodiscard]] std::string spelled_out(const Case& one);

// The resolved echo: TOML with all defaults written out, which reads back as the same run. `chosen`
// gives for cases that were run, by name, the values that replaced `auto`.
using Chosen = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] std::string echo(const Family& family, const Chosen& chosen = {});

// The reference manual of all keys in markdown: docs/scenario.md.
[[nodiscard]] std::string manual();

// The files for find_materials().
struct Sources {
  struct ReadFile {
    InputFile file;
    Place place;  // of the key that names it
  };
  const std::string& folder;
  const Library& known;                // read before
  Library found = {};                  // read by this call
  std::vector<ReadFile> read = {};     // the files of `found`
  std::vector<std::string> used = {};  // names of all files that the scenario needs
};

// Sets values that depend on which keys the document contains: the regions of a limb, the shape and
// mesh of specimens that are not cuboids, the viscosity of the contact.
void complete(Scenario& scenario, const Node& document);

// The mesh of a scenario that gives none, refined where needed: a structured mesh for a cuboid
// without inclusions, else TetGen's.
[[nodiscard]] Mesh mesh_left_open(const Scenario& scenario);

// The tissue's law of time: none where its material has no time for the default one and nothing
// asks for it.
[[nodiscard]] tissue::Viscosity law_of(const Scenario& scenario, const material::Tissue& material,
                                       const Node& document);

// Looks up the materials, and reads the geometry files of the scenario. Adds to `problems`, with
// places in the document. If there are problems already, only the materials are looked up, so that
// no mistake is reported twice.
[[nodiscard]] Materials find_materials(const Scenario& scenario, const Node& document,
                                       Sources& sources, std::vector<Problem>& problems);

// Checks that involve several keys: the order of steps, incompatible methods, depths beyond the
// specimen. Adds to `problems`.
void check(const Case& one, const Node& document, std::vector<Problem>& problems);

// What `act` returns. A KeyError that it throws becomes an InputError at the place of its key.
template <class Act>
auto at_its_key(const Node& document, const Act& act) {
  try {
    return act();
  } catch (const KeyError& error) {
    throw InputError(place_of(document, error.key()), error.what());
  }
}

// The path itself if it is `-`, has a folder or an ending, or is a file that exists. A bare name
// such as `quickstart` is an installed example where share/palpate/scenarios beside the program's
// folder has one, or the checkout in which the program was built; otherwise it stays as it is.
[[nodiscard]] std::string find(const std::string& given);

// The same of a scenario that is read. Throws InputError with the way to a first scenario if a bare
// name is none of them.
[[nodiscard]] std::string file_of(const std::string& given);

// The names of the installed examples, in alphabetical order.
[[nodiscard]] std::vector<std::string> examples();

}  // namespace palpate::scenario
