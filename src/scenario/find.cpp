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
  const fs::path top = program.parent_path().parent_path();
  const fs::path installed = top / "share/palpate/scenarios";
  // A program that was built in a checkout takes those of the checkout.
  const fs::path own = top.parent_path() / "scenarios";
  if (!fs::exists(installed, error) && fs::exists(own / "quickstart.toml", error)) return own;
  return error ? fs::path() : installed;
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
