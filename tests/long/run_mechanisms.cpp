// Every choice of a mechanism is made by a scenario that is shipped, so that none stays without a
// use.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "every.h"
#include "run/choose.h"
#include "scenario/family.h"
#include "scenario/words.h"
#include "scene/scene.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;
namespace words = scenario::words;

// The scenarios of scenarios/ and golden/, but for those that fail on purpose.
std::set<fs::path> shipped() {
  const fs::path source(PALPATE_SOURCE_DIR);
  std::set<fs::path> found;
  for (const char* folder : {"scenarios", "golden"})
    for (const auto& entry : fs::recursive_directory_iterator(source / folder)) {
      const fs::path& path = entry.path();
      if (path.extension() != ".toml" || path.parent_path().filename() == "expected" ||
          path.parent_path().filename() == "failures")
        continue;
      std::ostringstream text;
      text << std::ifstream(path).rdbuf();
      if (text.str().find("[[step]]") != std::string::npos) found.insert(path);
    }
  return found;
}

// By mechanism the scenarios that reach it: what the choice of a model leaves of their keys.
std::map<std::string, std::set<std::string>> reached() {
  std::map<std::string, std::set<std::string>> by;
  for (const fs::path& path : shipped()) {
    const scenario::Family family = scenario::read(path.string(), {});
    for (const scenario::Case& one : family.cases) {
      const scenario::Resolved run = run::choose(one).chosen;
      const auto note = [&](const std::string& key, const auto& of, auto value) {
        by[key + " = " + word(of, value)].insert(path.lexically_relative(PALPATE_SOURCE_DIR));
      };
      note("solver.model", words::models, run.solver.model);
      if (run.meshed()) {
        note("solver.integrator", words::integrators, run.solver.integrator);
        note("solver.volume", words::volumes, run.solver.volume);
        note("solver.kinematics", words::kinematics_words, run.solver.kinematics);
        note("tissue.viscosity", words::viscosities, run.tissue.viscosity);
        if (scenario::traits(run.solver.model).independent())
          note("solver.stiffness", words::stiffnesses, run.solver.stiffness);
      }
      if (run.uniform()) continue;
      note("contact.law", words::laws, run.contact.law);
      note("contact.viscosity", words::contact_viscosities, run.contact.viscosity);
      note("contact.depth", words::depths, run.contact.depth);
      if (run.contact.friction > 0.0) note("contact.slip", words::slips, run.contact.slip);
      if (!run.meshed()) continue;
      note("contact.coupling", words::couplings, run.contact.coupling);
      note("contact.curvature", words::curvature_methods, run.contact.curvature);
      note("contact.curvature_on", words::curvature_surfaces, run.contact.curvature_on);
      note("contact.spread", words::loaded, run.contact.spread);
    }
  }
  return by;
}

TEST(Mechanisms, AreReachedByAShippedScenario) {
  const auto by = reached();
  std::ostringstream list;
  for (const auto& [mechanism, scenarios] : by)
    list << mechanism << ": " << *scenarios.begin() << "\n";
  std::string missing;
  const auto look = [&](const std::string& key, const auto& of) {
    for (const std::string& one : test::every(of))
      if (!by.contains(key + " = " + one)) missing += key + " = " + one + "\n";
  };
  look("solver.model", words::models);
  look("solver.integrator", words::integrators);
  look("solver.volume", words::volumes);
  look("solver.kinematics", words::kinematics_words);
  look("solver.stiffness", words::stiffnesses);
  look("tissue.viscosity", words::viscosities);
  look("contact.law", words::laws);
  look("contact.viscosity", words::contact_viscosities);
  look("contact.depth", words::depths);
  look("contact.slip", words::slips);
  look("contact.coupling", words::couplings);
  look("contact.curvature", words::curvature_methods);
  look("contact.curvature_on", words::curvature_surfaces);
  look("contact.spread", words::loaded);
  EXPECT_EQ(missing, "") << "of what is reached:\n" << list.str();
}

}  // namespace
}  // namespace palpate
