// Reads the files of results/ and finds the rows of cases by their ids.
#include "sweep/journal.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "base/error.h"

namespace palpate::sweep {
namespace {

namespace fs = std::filesystem;

using Whose = record::JournalFile::Whose;

// Whether a file name such as `3-of-16_...` names another part of the same division.
bool is_of_another_part(const std::string& name, const Shard& shard) {
  std::string part = name.substr(0, name.find('_'));
  if (part.starts_with("retry-")) part.erase(0, 6);
  return part.ends_with("-of-" + std::to_string(shard.of)) && part != shard.text();
}

}  // namespace

SweepResults::SweepResults(const SweepPlan& plan, const Shard& shard)
    : plan_(&plan), places_(plan.count()) {
  std::vector<std::uint32_t> by_id(plan.count());
  std::iota(by_id.begin(), by_id.end(), 0U);
  std::ranges::sort(by_id,
                    [&](std::uint32_t a, std::uint32_t b) { return plan.ids[a] < plan.ids[b]; });
  for (const std::string& path : record::journal_files(plan.folder + "/results"))
    if (!is_of_another_part(fs::path(path).filename().string(), shard)) read(path, by_id);
}

void SweepResults::read(const std::string& path, const std::vector<std::uint32_t>& by_id) {
  const auto number = static_cast<std::uint32_t>(files_.size());
  files_.push_back({.path = path});  // add() uses the path in its message
  files_.back() =
      record::read_journal(path, plan_->hash, [&](const record::Table& row, const FileLine& line) {
        auto head = head_of(row);
        if (!head) return false;
        head->seal = id_of(line.text.substr(0, 16)).value_or(0);
        const auto found = std::ranges::lower_bound(
            by_id, head->id, {}, [&](std::uint32_t each) { return plan_->ids[each]; });
        if (found == by_id.end() || plan_->ids[*found] != head->id) return false;
        add(*found, {.file = number, .head = *head, .offset = line.offset});
        return true;
      });
}

void SweepResults::add(std::size_t index, const RowPlace& place) {
  RowPlace& known = places_[index];
  if (known.known() && known.head.attempt == place.head.attempt &&
      known.head.seal != place.head.seal)
    throw SystemError(
        "case " + std::to_string(index + 1) + " (" + id_text(place.head.id) +
        ") has two different results, in " + files_[known.file].path + " and " +
        files_[place.file].path +
        ": the machines that made them do not compute alike; remove one of the files");
  if (!known.known() || place.head.attempt > known.head.attempt) known = place;
}

std::size_t SweepResults::corrupt() const {
  std::size_t lines = 0;
  for (const record::JournalFile& file : files_)
    if (file.whose != Whose::another) lines += file.corrupt + (file.torn ? 1 : 0);
  return lines;
}

std::vector<std::string> SweepResults::warnings() const {
  std::vector<std::string> sentences;
  for (const record::JournalFile& file : files_)
    for (std::string& sentence : file.warnings()) sentences.push_back(std::move(sentence));
  return sentences;
}

SweepRow SweepResults::row(std::size_t index) const {
  const RowPlace& place = places_[index];
  const std::string& path = files_[place.file].path;
  std::ifstream file(path, std::ios::binary);
  file.seekg(static_cast<std::streamoff>(place.offset));
  std::string line;
  std::getline(file, line);
  const auto sealed = record::read_line(line, plan_->hash);
  auto row = sealed ? row_of(*sealed) : std::nullopt;
  if (!row) throw SystemError(path + " has changed while it was read; try again");
  return std::move(*row);
}

}  // namespace palpate::sweep
