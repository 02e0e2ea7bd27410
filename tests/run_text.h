// Runs of scenarios that are texts, and what is read off their records.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "run/family.h"
#include "run/refined_mesh.h"
#include "scene_text.h"

namespace palpate::test {

inline record::CaseRecord run_scene(const scene::Scene& scene) { return run::run_case(scene); }

inline record::CaseRecord run_text(const std::string& text, const Settings& settings = {}) {
  const scenario::Family family = scenario::parse(text, "test.toml", settings);
  return run_scene(run::build_scene(family.cases.front(), family));
}

inline bool has_finding(const record::CaseRecord& record, const std::string& name) {
  return std::any_of(record.findings.begin(), record.findings.end(),
                     [&](const auto& finding) { return finding.name == name; });
}

inline record::Cell finding(const record::CaseRecord& record, const std::string& name) {
  for (const auto& finding : record.findings)
    if (finding.name == name) return finding.value;
  ADD_FAILURE() << "no finding " << name;
  return {};
}

inline double found(const record::CaseRecord& record, const std::string& name) {
  return std::get<double>(finding(record, name));
}

}  // namespace palpate::test
