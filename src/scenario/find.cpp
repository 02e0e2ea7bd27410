// Looks for examples from where the program is, so that an installation can be moved.
#include "scenario/find.h"

#include <filesystem>

#include "base/files.h"

namespace palpate::scenario {
namespace {

namespace fs = std::filesystem;

fs::path example_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path().parent_path() / "share/palpate/scenarios";
}

}  // namespace

std::string find(const std::string& given) {
  const fs::path path(given);
  std::error_code error;
  if (given == "-" || path.has_parent_path() || path.has_extension() || fs::exists(path, error))
    return given;
  const fs::path example = example_folder() / (given + ".toml");
  return fs::is_regular_file(example, error) ? example.string() : given;
}

std::vector<std::string> examples() {
  std::vector<std::string> names;
  for (const std::string& entry : entries_of(example_folder().string()))
    if (fs::path(entry).extension() == ".toml") names.push_back(fs::path(entry).stem().string());
  return names;
}

}  // namespace palpate::scenario
