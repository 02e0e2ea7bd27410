// A case by what it computes, not by what it is called.
#include <algorithm>
#include <filesystem>

#include "base/field_writer.h"
#include "base/files.h"
#include "study/sweep_plan.h"
#include "study/sweep_row.h"

namespace palpate::study {
namespace {

// The files of the geometry that the case reads: a mesh in two files has one stem.
std::string stem_of_geometry(const scenario::Scenario& scenario) {
  std::string file;
  if (const auto* surface = std::get_if<scenario::SurfaceFile>(&scenario.tissue.shape))
    file = surface->file;
  if (const auto* mesh = std::get_if<scenario::MeshFile>(&scenario.tissue.mesh)) file = mesh->file;
  return std::filesystem::path(file).stem().string();
}

}  // namespace

HashedNames hashed_inputs(const scenario::Family& family) {
  HashedNames names;
  for (const scenario::InputFile& input : family.inputs)
    names.emplace_back(input.name, sha256(input.content));
  return names;
}

std::uint64_t case_id(const scenario::Case& one, const HashedNames& files) {
  scenario::Scenario scenario = one.scenario;
  std::string text =
      fields_as_toml([&](FieldVisitor& visitor) { scenario::fields(visitor, scenario); });
  const std::string stem = stem_of_geometry(scenario);
  if (!stem.empty())
    for (const auto& [name, hash] : files)
      if (std::filesystem::path(name).stem() == stem) text += name + " " + hash + "\n";
  return id_of(sha256(text).substr(0, 16)).value_or(0);
}

}  // namespace palpate::study
