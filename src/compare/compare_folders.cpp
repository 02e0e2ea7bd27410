// Compares two folders file by file.
#include "compare/compare_folders.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include "base/error.h"
#include "record/csv.h"

namespace palpate::compare {
namespace {

using State = FileComparison::State;

// The sorted paths of the CSV files below a folder, relative to it.
std::set<std::string> csv_files(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::set<std::string> files;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error))
    if (entry->is_regular_file(error) && entry->path().extension() == ".csv")
      files.insert(entry->path().lexically_relative(folder).generic_string());
  if (error)
    throw InputError({folder, 0, 0},
                     "cannot be read: " + error.message() + "; give a folder of results");
  return files;
}

std::string below(const std::string& folder, const std::string& file) {
  return (std::filesystem::path(folder) / file).string();
}

}  // namespace

bool FolderComparison::equal() const {
  return std::all_of(files.begin(), files.end(), [](const auto& each) { return each.equal(); });
}

FolderComparison compare_folders(const std::string& got, const std::string& want,
                                 const Tolerances& tolerances) {
  const std::set<std::string> wanted = csv_files(want);
  const std::set<std::string> found = csv_files(got);
  if (wanted.empty())
    throw InputError({want, 0, 0}, "holds no CSV file to compare with; give a folder of results");
  std::set<std::string> all = wanted;
  all.insert(found.begin(), found.end());
  FolderComparison folders;
  for (const std::string& file : all) {
    FileComparison result{.file = file};
    if (!found.contains(file)) {
      result.state = State::missing;
    } else if (!wanted.contains(file)) {
      result.state = State::extra;
    } else {
      const record::Table left = record::read_csv(below(got, file));
      const record::Table right = record::read_csv(below(want, file));
      result.comparison = compare(left, right, tolerances);
    }
    folders.files.push_back(result);
  }
  return folders;
}

std::string comparison_text(const FolderComparison& comparison) {
  std::string text;
  for (const FileComparison& file : comparison.files) {
    switch (file.state) {
      case State::missing: text += file.file + ": DIFFERS, the file is missing\n"; break;
      case State::extra: text += file.file + ": DIFFERS, the file is not wanted\n"; break;
      case State::compared:
        text += file.file + (file.comparison.equal() ? ": equal\n" : ": DIFFERS\n");
        text += comparison_text(file.comparison);
        break;
    }
  }
  return text;
}

}  // namespace palpate::compare
