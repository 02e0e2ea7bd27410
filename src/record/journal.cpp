// A line is the seal, a tab, and the row as CSV (header and values) with escaped line feeds.
#include "record/journal.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "record/csv.h"

namespace palpate::record {
namespace {

namespace fs = std::filesystem;

constexpr const char* ending = ".rows";
constexpr std::size_t digits = 16;  // of a seal
// The number is raised with every change of the format, and with it all seals change.
const std::string greeting = "palpate rows 2\t";

std::string header_of(std::string_view identity) { return greeting + std::string(identity) + "\n"; }

std::string escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size() + text.size() / 8);
  for (const char c : text) {
    if (c == '\\' || c == '\n') out += '\\';
    out += c == '\n' ? 'n' : c;
  }
  return out;
}

std::string plain(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '\\' && i + 1 < text.size();
    if (escape) ++i;
    out += escape && text[i] == 'n' ? '\n' : text[i];
  }
  return out;
}

std::string seal_of(std::string_view content, std::string_view identity) {
  Sha256 hash;
  hash.add(header_of(identity));
  hash.add(content);
  return hash.digits().substr(0, digits);
}

// The first file name of this process that does not exist yet.
std::string free_name(const std::string& folder, const std::string& part) {
  make_folders(folder);
  const std::string stem =
      folder + "/" + part + "_" + host_name() + "_" + std::to_string(::getpid()) + "_";
  int count = 1;
  while (fs::exists(stem + std::to_string(count) + ending)) ++count;
  return stem + std::to_string(count) + ending;
}

}  // namespace

std::string sealed_line(const Table& row, std::string_view identity) {
  const std::string content = escaped(csv_text(row));
  return seal_of(content, identity) + "\t" + content + "\n";
}

std::optional<Table> read_line(std::string_view line, std::string_view identity) {
  if (line.size() <= digits || line[digits] != '\t') return std::nullopt;
  const std::string_view content = line.substr(digits + 1);
  if (line.substr(0, digits) != seal_of(content, identity)) return std::nullopt;
  // Anybody can compute a seal: what is behind a good one may still be no row.
  try {
    Table row = parse_csv(plain(content), "row");
    if (row.rows.size() == 1) return row;
  } catch (const InputError&) {
  }
  return std::nullopt;
}

std::vector<std::string> JournalFile::warnings() const {
  std::vector<std::string> sentences;
  if (whose == Whose::another)
    return {path + " belongs to another plan, chart or version and is ignored"};
  if (corrupt > 0)
    sentences.push_back(path + " has " + std::to_string(corrupt) +
                        (corrupt == 1 ? " corrupt line; its row counts as missing"
                                      : " corrupt lines; their rows count as missing"));
  if (torn) sentences.push_back(path + " ends with an incomplete line; its row counts as missing");
  return sentences;
}

JournalFile read_journal(const std::string& path, std::string_view identity, const RowSeen& see) {
  using Whose = JournalFile::Whose;
  JournalFile file{.path = path};
  const std::string header = header_of(identity);
  for_each_line(path, [&](const FileLine& line) {
    const bool first = line.offset == 0;
    if (first && line.whole && line.text.size() + 1 == header.size() &&
        line.text.starts_with(greeting)) {
      file.whose = header.starts_with(line.text) ? Whose::ours : Whose::another;
      return;
    }
    const auto row = line.whole ? read_line(line.text, identity) : std::nullopt;
    if (row && see(*row, line)) {
      ++file.rows;
      file.whose = Whose::ours;  // even if the header is damaged
    } else {
      (line.whole ? void(++file.corrupt) : void(file.torn = true));
    }
  });
  return file;
}

std::vector<std::string> journal_files(const std::string& folder) {
  if (::access(folder.c_str(), R_OK) != 0 && errno != ENOENT && errno != ENOTDIR)
    throw SystemError(folder + " cannot be read: " + std::strerror(errno));
  std::vector<std::string> paths = entries_of(folder);
  std::erase_if(paths, [](const std::string& path) { return !path.ends_with(ending); });
  return paths;
}

Journal::Journal(const std::string& folder, const std::string& part, std::string identity)
    : identity_(std::move(identity)), file_(free_name(folder, part)) {
  file_.append(header_of(identity_));
}

void Journal::add(const Table& row) { file_.append(sealed_line(row, identity_)); }

}  // namespace palpate::record
