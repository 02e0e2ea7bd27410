// The collecting thread: takes rows and traffic from their queues, keeps the rows and writes files.
#include "live/loop.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "record/csv.h"

namespace palpate::live {
namespace {

constexpr std::size_t batch = 4096;  // rows taken, and rows written, at a time

}  // namespace

LiveLog::LiveLog(std::function<void(int)> on_step, LogPlan plan)
    : on_step_(std::move(on_step)),
      plan_(std::move(plan)),
      rows_file_(plan_.rows_file),
      traffic_file_(plan_.traffic_file),
      piece_(1) {
  piece_.front().name = plan_.case_name;
  thread_ = std::thread([this] { work(); });
}

LiveLog::~LiveLog() {
  over_ = true;
  if (thread_.joinable()) thread_.join();
}

void LiveLog::wait_for_room() const {
  constexpr auto pause = std::chrono::microseconds(200);
  while (pushed_ - done_.load(std::memory_order_acquire) >= lead)
    std::this_thread::sleep_for(pause);
}

void LiveLog::tell(std::string sentence) {
  if (plan_.on_trouble) plan_.on_trouble(sentence);
  troubles_.push_back(std::move(sentence));
}

// Writes traffic, which is not kept in memory: what cannot be written is lost. Returns whether a
// full batch was taken, so that there may be more.
bool LiveLog::collect_traffic() {
  if (plan_.tap == nullptr) return false;
  std::string text;
  device::Tap::Part part;
  std::size_t taken = 0;
  for (; taken < batch && plan_.tap->take(part); ++taken) {
    if (first_time_ < 0.0) {
      first_time_ = part.time;
      text = "time_s,way,bytes\n";
    }
    bytes_.append(part.bytes.data(), part.size);
    if (!part.last) continue;
    text += number_text(part.time - first_time_) +
            (part.way == device::Tap::Way::sent ? ",sent," : ",received,") + bytes_text(bytes_) +
            "\n";
    bytes_.clear();
  }
  if (traffic_told_) return taken == batch;
  if (!text.empty()) (void)traffic_file_.append(text);
  traffic_file_.sync_when_due();
  if (!traffic_file_.trouble().empty()) {
    traffic_told_ = true;
    tell(traffic_file_.trouble() + "; no more of the traffic is kept");
  }
  return taken == batch;
}

// Takes rows into memory. Returns whether a full batch was taken.
bool LiveLog::collect_rows() {
  LogRow row;
  std::size_t taken = 0;
  while (taken < batch && ring_->pop(row)) {
    ++taken;
    rows_.push_back(row);
    if (row.contact.step != step_) on_step_(step_ = row.contact.step);
  }
  return taken == batch;
}

// Writes rows as lines, equal to those of the complete table. Returns whether all are written.
bool LiveLog::write_rows() {
  if (!rows_file_.named()) return true;
  const std::size_t end = std::min(in_file_ + batch, rows_.size());
  if (end > in_file_) {
    record::CaseRecord& piece = piece_.front();
    piece.contact.clear();
    piece.measured.clear();
    for (std::size_t i = in_file_; i < end; ++i) {
      piece.contact.push_back(rows_[i].contact);
      piece.measured.push_back(rows_[i].measured);
    }
    const std::string table = record::csv_text(plan_.table(piece_));
    const std::size_t header = has_header_ ? table.find('\n') + 1 : 0;
    const std::string_view text = std::string_view(table).substr(header);
    const std::string_view taken = text.substr(0, rows_file_.append(text));
    auto lines = as_index(std::ranges::count(taken, '\n'));
    if (lines > 0 && !has_header_) --lines;
    has_header_ = has_header_ || !taken.empty();
    in_file_ = taken.size() == text.size() ? end : in_file_ + lines;
  }
  rows_file_.sync_when_due();
  if (!rows_told_ && !rows_file_.trouble().empty()) {
    rows_told_ = true;
    tell(rows_file_.trouble() + "; until the run ends its rows are in memory");
  }
  return in_file_ == rows_.size();
}

bool LiveLog::collect() {
  const bool more_traffic = collect_traffic();
  const bool more_rows = collect_rows();
  const bool written = write_rows();
  // A row is done when the traffic of its frame is written as well.
  if (!more_traffic) done_.store(rows_.size(), std::memory_order_release);
  return more_traffic || more_rows || (!written && rows_file_.trouble().empty());
}

void LiveLog::work() {
  constexpr auto pause = std::chrono::milliseconds(5);
  while (!over_)
    if (!collect()) std::this_thread::sleep_for(pause);
}

std::vector<LogRow> LiveLog::finish() {
  over_ = true;
  thread_.join();
  rows_file_.try_again();
  while (collect()) {
  }
  for (std::size_t before = in_file_; !write_rows() && in_file_ > before;) before = in_file_;
  rows_file_.sync();
  traffic_file_.sync();
  (void)collect();  // reports errors of the last writes
  written_ = in_file_ > 0 && in_file_ == rows_.size() && rows_file_.trouble().empty();
  if (plan_.tap != nullptr && plan_.tap->dropped() > 0)
    tell(std::to_string(plan_.tap->dropped()) +
         " parts of the traffic are missing, because their buffer was full");
  if (dropped() > 0)
    tell(std::to_string(dropped()) + " rows are missing, because the log was full");
  return std::move(rows_);
}

// Writes a live file; an error becomes a sentence, and the next attempt follows a second later.

namespace {

constexpr auto pause = std::chrono::seconds(1);
constexpr std::size_t page = 4096;  // bytes

}  // namespace

LiveFile::LiveFile(std::string path) : path_(std::move(path)) {}

std::size_t LiveFile::append(std::string_view text) {
  if (!named() || Clock::now() < next_try_) return 0;
  std::size_t taken = 0;
  try {
    if (!file_) file_ = std::make_unique<GrowingFile>(path_);
    while (taken < text.size()) {
      const std::string_view piece = text.substr(taken, next_piece(text.substr(taken)));
      file_->append(piece);
      taken += piece.size();
      size_ += piece.size();
    }
  } catch (const SystemError& error) {
    fail(error.what());
  }
  if (taken > 0 && !dirty_) next_sync_ = Clock::now() + pause;
  dirty_ = dirty_ || taken > 0;
  return taken;
}

// The length of the lines that fit into the current page of the file, or of one longer line:
// SIGKILL may end a longer write at a page boundary, within a line.
std::size_t LiveFile::next_piece(std::string_view text) const {
  const std::size_t last = text.substr(0, page - size_ % page).rfind('\n');
  if (last != std::string_view::npos) return last + 1;
  return std::min(text.find('\n'), text.size() - 1) + 1;
}

void LiveFile::sync_when_due() {
  if (dirty_ && Clock::now() >= next_sync_) sync();
}

void LiveFile::sync() {
  if (!dirty_) return;
  dirty_ = false;
  try {
    file_->sync();
  } catch (const SystemError& error) {
    fail(error.what());
  }
}

// The sentence becomes part of a result, without the folder, whose name has a process number.
void LiveFile::fail(const std::string& why) {
  next_try_ = Clock::now() + pause;
  if (!trouble_.empty()) return;
  trouble_ = why.starts_with(path_)
                 ? std::filesystem::path(path_).filename().string() + why.substr(path_.size())
                 : why;
}

}  // namespace palpate::live
