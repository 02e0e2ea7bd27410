// A map is whole or not there.
#include "report/stability_folder.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "base/files.h"
#include "record/csv.h"

namespace palpate::report {
namespace {

namespace fs = std::filesystem;

constexpr const char* table = "stability.csv";

void move(const std::string& from, const std::string& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw SystemError(from + " cannot be renamed to " + to + ": " + error.message());
}

// Gone at the end, unless it has been renamed.
struct Beside {
  std::string path;
  explicit Beside(std::string folder) : path(std::move(folder)) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw SystemError(path + " cannot be made: " + error.message());
  }
  ~Beside() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;
};

}  // namespace

StabilityFolder::StabilityFolder(const std::string& out, const std::string& name, bool replace)
    : name_(name), path_((fs::path(out) / (name + "_stability")).string()) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(path_, ignored))) return;
  const bool map = fs::exists(path_ + "/" + table);
  if (map && !replace)
    throw InputError({path_, 0, 0},
                     "holds a finished map; give `--force` to replace it, or another `--out`");
  if (!map && (!fs::is_directory(path_) || !fs::is_empty(path_)))
    throw InputError({path_, 0, 0},
                     "is there and is no stability map, so that it is not replaced; give another "
                     "`--out`, or rename the scenario");
}

std::string StabilityFolder::write(const study::StabilityMap& map) const {
  const Beside beside(path_ + ".partial-" + std::to_string(::getpid()));
  write_atomically(beside.path + "/" + table, record::csv_text(study::limit_table(map)));
  write_atomically(beside.path + "/failures.csv", record::csv_text(study::failure_table(map)));
  const Drawing drawing = draw(stability_sheet(name_, map), beside.path);
  if (!fs::exists(path_)) {
    move(beside.path, path_);
    return drawing.warning;
  }
  // The old map steps aside until the new one stands.
  const Beside aside(beside.path + ".old");
  move(path_, aside.path);
  move(beside.path, path_);
  return drawing.warning;
}

}  // namespace palpate::report
