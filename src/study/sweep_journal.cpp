// A line is written at once or not at all; what was torn all the same has a seal that does not fit.
#include "study/sweep_journal.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <numeric>
#include <utility>

#include "base/error.h"

namespace palpate::study {
namespace {

namespace fs = std::filesystem;

const std::string greeting = "palpate sweep rows 1\t";

// The first name of this process that nobody has taken.
std::string free_name(const std::string& folder, const std::string& part) {
  const std::string stem =
      (fs::path(folder) / (part + "_" + host_name() + "_" + std::to_string(::getpid()) + "_"))
          .string();
  int start = 1;
  while (fs::exists(stem + std::to_string(start) + ".rows")) ++start;
  return stem + std::to_string(start) + ".rows";
}

// By its name: `3-of-16_...` where part 5 of 16 is asked for.
bool is_of_another_part(const std::string& name, const Shard& shard) {
  const std::string part = name.substr(0, name.find('_'));
  return part.ends_with("-of-" + std::to_string(shard.of)) && part != shard.text();
}

}  // namespace

SweepJournal::SweepJournal(const SweepPlan& plan, const std::string& part) : plan_(plan.hash) {
  const std::string folder = (fs::path(plan.folder) / "results").string();
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw SystemError("`" + folder + "` cannot be made: " + error.message());
  file_ = std::make_unique<GrowingFile>(free_name(folder, part));
  file_->append(greeting + plan.hash + "\n");
}

void SweepJournal::add(const SweepRow& row) {
  file_->append(row_line(row, plan_));
  changed_ = true;
}

void SweepJournal::sync() {
  if (changed_) file_->sync();
  changed_ = false;
}

SweepResults::SweepResults(const SweepPlan& plan, const Shard& shard)
    : plan_(&plan), places_(plan.count()) {
  const fs::path folder = fs::path(plan.folder) / "results";
  std::vector<std::string> paths;
  std::error_code error;
  if (fs::exists(folder))
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (entry.path().extension() == ".rows" &&
          !is_of_another_part(entry.path().filename().string(), shard))
        paths.push_back(entry.path().string());
  if (error) throw SystemError(folder.string() + " cannot be read: " + error.message());
  std::sort(paths.begin(), paths.end());
  std::vector<std::uint32_t> by_id(plan.count());
  std::iota(by_id.begin(), by_id.end(), 0U);
  std::sort(by_id.begin(), by_id.end(),
            [&](std::uint32_t a, std::uint32_t b) { return plan.ids[a] < plan.ids[b]; });
  for (const std::string& path : paths) read(path, by_id);
}

void SweepResults::read(const std::string& path, const std::vector<std::uint32_t>& by_id) {
  const auto number = static_cast<std::uint32_t>(files_.size());
  RowFile file{.path = path};
  files_.push_back(file);  // add() names it
  bool first = true;
  for_each_line(path, [&](const FileLine& line) {
    const bool header = std::exchange(first, false);
    if (header && line.text.starts_with(greeting)) {
      file.foreign = line.whole && line.text.substr(greeting.size()) != plan_->hash &&
                     line.text.size() == greeting.size() + plan_->hash.size();
      if (line.whole) return;
    }
    const auto head = line.whole ? read_head(line.text, plan_->hash) : std::nullopt;
    if (!head) {
      (line.whole ? void(++file.corrupt) : void(file.torn = true));
      return;
    }
    const auto found =
        std::lower_bound(by_id.begin(), by_id.end(), head->id,
                         [&](std::uint32_t a, std::uint64_t id) { return plan_->ids[a] < id; });
    if (found == by_id.end() || plan_->ids[*found] != head->id) {
      ++file.corrupt;
      return;
    }
    file.foreign = false;  // the header lied
    ++file.rows;
    add(*found, {.file = number, .head = *head, .offset = line.offset});
  });
  files_.back() = file;
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
  for (const RowFile& file : files_)
    if (!file.foreign) lines += file.corrupt + (file.torn ? 1 : 0);
  return lines;
}

std::vector<std::string> SweepResults::warnings() const {
  std::vector<std::string> sentences;
  for (const RowFile& file : files_) {
    if (file.foreign)
      sentences.push_back(file.path +
                          " is of another plan or another version and counts for nothing");
    else if (file.corrupt > 0)
      sentences.push_back(file.path + " has " + std::to_string(file.corrupt) +
                          " corrupt lines; their cases count as missing");
    if (!file.foreign && file.torn)
      sentences.push_back(file.path + " ends in half a line; its case counts as missing");
  }
  return sentences;
}

SweepRow SweepResults::row(std::size_t index) const {
  const RowPlace& place = places_[index];
  const std::string& path = files_[place.file].path;
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  std::string text;
  std::size_t end = std::string::npos;
  while (file >= 0 && end == std::string::npos) {
    std::array<char, 8192> part{};
    const ssize_t got =
        ::pread(file, part.data(), part.size(), static_cast<off_t>(place.offset + text.size()));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    const std::size_t before = text.size();
    text.append(part.data(), static_cast<std::size_t>(got));
    end = text.find('\n', before);
  }
  if (file >= 0) ::close(file);
  auto row = read_row(std::string_view(text).substr(0, end), plan_->hash);
  if (!row) throw SystemError(path + " has changed while it was read; try again");
  return std::move(*row);
}

}  // namespace palpate::study
