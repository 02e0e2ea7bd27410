// Replaces a result folder. The list of the new folder is written before the exchange and names the
// list that it replaces. From this a later process can tell the new folder from the old one and
// complete the work of a killed process.
#include "base/whole_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <system_error>

#include "base/error.h"
#include "base/text.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using State = WholeFolder::State;

// One line per file in the format of `sha256sum --check`; other lines start with `#`.
constexpr const char* list_name = "contents.sha256";
constexpr const char* aside_ending = ".old";  // of the old folder, on file systems without exchange
constexpr int most_tries = 1000;  // to make a folder that others remove before its list is written

// The folder's list: empty while a partial folder has nothing to keep, nullopt without a list.
std::optional<std::string> list_of(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_regular_file(folder / list_name, ignored)) return std::nullopt;
  try {
    return read_text((folder / list_name).string());
  } catch (const InputError&) {
    return std::nullopt;
  }
}

std::string first_line(const std::string& kind, State content) {
  return "# palpate " + kind + (content == State::complete ? ", complete\n" : ", incomplete\n");
}
std::string replaces_line(const std::string& list) { return "# replaces " + sha256(list) + "\n"; }
std::string keeps_line(const std::string& name) { return "# keeps " + name + "\n"; }
std::string origin_line(const std::string& origin) {
  return origin.empty() ? "" : "# origin " + sha256(origin) + "\n";
}
std::string file_line(const HashedFile& file) { return file.sha256 + "  " + file.path + "\n"; }

bool has(const std::string& list, const std::string& line) {
  return list.find(line) != std::string::npos;
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

// Whether the partial folder contains something that its list marks with `# keeps`.
bool holds_what_it_keeps(const fs::path& partial, const std::string& list) {
  for (const std::string& line : split(list, '\n'))
    if (line.starts_with("# keeps ") && is_there(partial / line.substr(8))) return true;
  return false;
}

// Whether palpate wrote the file and it is unchanged since.
bool is_ours(const fs::path& file, const std::string& list) {
  std::error_code ignored;
  if (fs::symlink_status(file, ignored).type() != fs::file_type::regular) return false;
  try {
    const HashedFile one{file.filename().string(), file_sha256(file.string())};
    return has(list, "\n" + file_line(one));
  } catch (const InputError&) {
    return false;
  }
}

// Renames unless the new name is taken; then returns false and sets errno to EEXIST.
bool rename_where_free(const fs::path& from, const fs::path& to) {
  const auto move = [&](unsigned int how) {
    return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), how) == 0;
  };
  if (move(RENAME_NOREPLACE)) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  if (!is_there(to)) return move(0);  // the file system cannot check and rename in one operation
  errno = EEXIST;
  return false;
}

// Removes from a partial folder everything that its list does not name (kept only for a kill).
// Tries twice, because an error of the disk may pass. Returns the names of what is left
// nevertheless.
std::vector<std::string> remove_unlisted(const fs::path& partial, const std::string& list) {
  std::vector<std::string> left;
  for (const fs::path entry : entries_of(partial.string())) {
    const std::string name = "  " + entry.filename().string();
    if (name.substr(2) == list_name || has(list, name + "\n") || has(list, name + "/")) continue;
    std::error_code error;
    fs::remove_all(entry, error);
    if (error) fs::remove_all(entry, error);
    if (error) left.push_back(name.substr(2));
  }
  return left;
}

// Deletes the list last, so that another process can continue if this one is killed.
void remove_partial(const fs::path& partial) {
  std::error_code ignored;
  (void)remove_unlisted(partial, "");
  fs::remove_all(partial, ignored);
}

// Removes a folder that was abandoned before its first list existed. If its list is just being
// created, the folder stays, because the writer locks the file before it gets its final name.
void remove_begun(const std::string& folder) {
  for (const std::string& entry : entries_of(folder))
    if (HeldFile temporary;
        fs::path(entry).filename().string().starts_with(list_name) && temporary.take(entry))
      ::unlink(entry.c_str());
  ::rmdir(folder.c_str());
}

// Deletes palpate's files from an old folder and moves all others to the new one. Returns warnings.
std::vector<std::string> dissolve(const fs::path& old, const fs::path& place) {
  std::vector<std::string> sentences;
  const std::string list = list_of(old).value_or("");
  std::vector<std::string> entries = entries_of(old.string());
  bool all_moved = true;
  // First the files whose names are free at the place, so that none of them has to be renamed.
  std::stable_partition(entries.begin(), entries.end(),
                        [&](const fs::path& entry) { return !is_there(place / entry.filename()); });
  for (const fs::path entry : entries) {
    const std::string name = entry.filename().string();
    if (name == list_name && !list.empty()) continue;
    if (is_ours(entry, list)) {
      ::unlink(entry.c_str());
      continue;
    }
    std::string kept = name;
    bool moved = rename_where_free(entry, place / kept);
    for (int i = 1; !moved && errno == EEXIST; ++i) {
      kept = name + ".before" + (i > 1 ? "-" + std::to_string(i) : "");
      moved = rename_where_free(entry, place / kept);
    }
    if (moved && kept != name)
      sentences.push_back((place / kept).string() + " is the `" + name +
                          "` of the replaced result; it is kept because it is not, or no longer, "
                          "as palpate wrote it");
    if (moved || errno == ENOENT) continue;  // ENOENT: another process has moved it
    all_moved = false;
    sentences.push_back(entry.string() + " cannot be moved to " + place.string() + ": " +
                        std::strerror(errno));
  }
  ::unlink((old / list_name).c_str());  // last, so that another process can continue
  // A file that another process moved to the place during the exchange may have ended up here.
  if (::rmdir(old.c_str()) != 0 && errno == ENOTEMPTY && all_moved)
    for (std::string& sentence : dissolve(old, place)) sentences.push_back(std::move(sentence));
  return sentences;
}

bool exchange(const std::string& one, const std::string& other) {
  return ::renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0;
}

// Moves a partial folder to its place. Returns the present path of the old folder (empty if there
// was none), or nullopt if the folder at the place must not be replaced. `may_go` is asked again
// after the exchange, because another process may have put a different folder there.
std::optional<std::string> put_at(const std::string& partial, const std::string& place,
                                  const std::function<bool(const std::string& folder)>& may_go) {
  std::string old;
  struct stat there {};
  if (::stat(place.c_str(), &there) == 0 && S_ISDIR(there.st_mode))  // it may be private
    (void)::chmod(partial.c_str(), there.st_mode & 07777);
  while (::rename(partial.c_str(), place.c_str()) != 0) {
    const auto refuse = [&](const std::string& from, const std::string& to) {
      throw SystemError(from + " cannot be renamed to " + to + ": " + std::strerror(errno));
    };
    if (errno != ENOTEMPTY && errno != EEXIST) refuse(partial, place);
    if (!may_go(place)) return std::nullopt;
    if (exchange(partial, place)) {
      if (may_go(partial) || !exchange(partial, place)) return partial;
      return std::nullopt;
    }
    if (errno == ENOENT) continue;
    // A file system without exchange; clear_up() of a later process recognises this name.
    old = partial + aside_ending;
    if (::rename(place.c_str(), old.c_str()) != 0 && errno != ENOENT) refuse(place, old);
    if (!may_go(old) && ::rename(old.c_str(), place.c_str()) == 0) return std::nullopt;
  }
  return old;
}

// The first file of the folder's list that is missing or changed; empty if there is none.
std::string changed_file(const fs::path& folder) {
  const std::string list = list_of(folder).value_or("");
  for (const std::string& line : split(list, '\n')) {
    const std::size_t gap = line.find("  ");
    if (line.starts_with('#') || gap == std::string::npos) continue;
    if (!is_ours(folder / line.substr(gap + 2), list)) return line.substr(gap + 2);
  }
  return "";
}

// What a list says that its folder holds.
State state_by(const std::string& list, const std::string& kind) {
  for (const State content : {State::complete, State::incomplete})
    if (list.starts_with(first_line(kind, content))) return content;
  return State::foreign;
}

State state_of(const std::string& folder, const std::string& kind) {
  std::error_code ignored;
  if (!is_there(folder)) return State::free;
  if (!fs::is_directory(folder, ignored)) return State::foreign;
  if (fs::is_empty(folder, ignored)) return State::free;
  return state_by(list_of(folder).value_or(""), kind);
}

}  // namespace

bool holds(const std::string& path, std::string_view content) {
  std::error_code error;
  return fs::is_regular_file(path, error) && read_text(path) == content;
}

WholeFolder::WholeFolder(const std::string& place, std::string kind, Replace replace,
                         const std::string& origin)
    : path_(place), kind_(std::move(kind)), replace_(replace), origin_line_(origin_line(origin)) {
  std::error_code error;
  if (fs::is_symlink(path_, error))
    if (const fs::path real = fs::canonical(path_, error); !error) path_ = real.string();
  partial_ = path_ + ".partial-" + std::to_string(::getpid());
  clear_up();
}

WholeFolder::~WholeFolder() {
  if (opened_ && !listed_ && kept().empty()) remove_partial(partial_);
}

std::string WholeFolder::kept() const {
  return opened_ && holds_what_it_keeps(partial_, to_keep_) ? partial_ : "";
}

std::vector<std::string> WholeFolder::left_beside() const {
  const fs::path place(path_);
  const std::string stem = place.filename().string() + ".partial-";
  std::vector<std::string> left;
  const std::string above = place.parent_path().string();
  for (const fs::path entry : entries_of(above.empty() ? "." : above)) {
    const std::string name = entry.filename().string();
    std::error_code ignored;
    if (name.starts_with(stem) && !(opened_ && name == fs::path(partial_).filename()) &&
        fs::symlink_status(entry, ignored).type() == fs::file_type::directory)
      left.push_back(fs::path(path_).replace_filename(name).string());
  }
  return left;
}

void WholeFolder::clear_up() const {
  for (const std::string& left : left_beside()) {
    const bool aside = left.ends_with(aside_ending);
    const std::string writer = left.substr(0, left.rfind('.')) + "/" + list_name;
    HeldFile held;  // meanwhile only dissolve() changes it
    if (!held.take(left + "/" + list_name)) {
      if (!is_there(left + "/" + list_name)) remove_begun(left);
      continue;
    }
    if (aside && is_there(writer) && !HeldFile().take(writer)) continue;
    const std::string list = list_of(left).value_or("");
    const auto is_replaced_by_it = [&](const std::string& folder) {
      return has(list, replaces_line(list_of(folder).value_or("")));
    };
    if (!list.starts_with("# palpate ")) {
      if (!holds_what_it_keeps(left, list)) remove_partial(left);
    } else if (has(list_of(path_).value_or(""), replaces_line(list))) {
      (void)dissolve(left, path_);
    } else if (aside) {
      if (!is_there(path_)) ::rename(left.c_str(), path_.c_str());
    } else if (list.starts_with(first_line(kind_, State::complete)) &&
               (!is_there(path_) || is_replaced_by_it(path_))) {
      try {
        (void)remove_unlisted(left, list);
        if (const auto old = put_at(left, path_, is_replaced_by_it); old && !old->empty())
          (void)dissolve(*old, path_);
      } catch (const SystemError&) {  // the folder stays where it is
      }
    }
  }
}

WholeFolder::State WholeFolder::state() const { return state_of(path_, kind_); }

bool WholeFolder::has_same_origin(const std::string& folder) const {
  return !origin_line_.empty() && has(list_of(folder).value_or(""), "\n" + origin_line_);
}

void WholeFolder::refuse_what_is_there() const {
  std::error_code error;
  if ((void)fs::status(partial_, error); error == std::errc::filename_too_long)
    throw InputError({path_, 0, 0}, "is too long for the name of a folder; give a shorter one");
  const State there = state();
  if (there == State::complete && replace_ == Replace::incomplete) {
    const bool same = has_same_origin(path_);
    const std::string changed = same ? changed_file(path_) : "";
    if (!same || !changed.empty())
      throw InputError({path_, 0, 0},
                       "holds a finished " + kind_ +
                           (origin_line_.empty() ? ""
                            : same ? " whose `" + changed + "` was changed or removed since"
                                   : " of other inputs or settings") +
                           "; give `--force` to replace it, or another `--out`");
  }
  if (there == State::foreign)
    throw InputError(
        {path_, 0, 0},
        "is there already and is not a " + kind_ + " that palpate wrote (its `" + list_name +
            "` is missing or says something else); rename it, or give another `--out`");
}

// Process numbers repeat, soon in containers; an abandoned folder's name is therefore not reused.
void WholeFolder::open() {
  make_folders(fs::path(path_).parent_path().string());
  std::error_code error;
  const std::string stem = partial_;
  for (int i = 2; !opened_; ++i) {
    const bool made = fs::create_directory(partial_, error);
    if (error) throw SystemError(partial_ + " cannot be made: " + error.message());
    if (made) try {
        list_.write(file(list_name), "");
        opened_ = true;
        return;
      } catch (const SystemError&) {
        // Another process may have removed the folder as abandoned. If it is there, and that again
        // and again, the disk is full.
        const bool was_there = fs::remove(partial_, error) || error;
        if (i > (was_there ? 4 : most_tries)) throw;
      }
    partial_ = stem + "-" + std::to_string(i);
  }
}

void WholeFolder::write(const std::string& name, std::string_view content, std::string hash) {
  make_folders(fs::path(file(name)).parent_path().string());
  write_atomically(file(name), content, Disk::later);
  files_.push_back({name, hash.empty() ? sha256(content) : std::move(hash)});
}

void WholeFolder::add(const std::vector<std::string>& names) {
  for (const std::string& name : names) files_.push_back({name, file_sha256(file(name))});
}

void WholeFolder::keep(const std::string& name) {
  to_keep_ += keeps_line(name);
  list_.write(file(list_name), to_keep_);
}

std::vector<std::string> WholeFolder::put(State content, std::vector<std::string> warnings) {
  const auto may_replace = [&](const std::string& folder) {
    const std::optional<std::string> there_listed = list_of(folder);
    if (!there_listed && is_there(fs::path(folder) / list_name))
      throw SystemError(
          folder + "/" + list_name +
          " cannot be read, so that nothing is replaced; the result of this run is in " + partial_);
    const State there = there_listed ? state_by(*there_listed, kind_) : state_of(folder, kind_);
    if (there == State::complete)
      return content == State::complete &&
             (replace_ == Replace::any ||
              (has_same_origin(folder) && changed_file(folder).empty()));
    return there != State::foreign;
  };
  std::string list = first_line(kind_, content) + origin_line_;
  if (const auto old = list_of(path_); old && may_replace(path_)) list += replaces_line(*old);
  for (const HashedFile& one : files_) list += file_line(one);
  // An interrupted run does not wait for the disk: the same call replaces what it leaves.
  if (content == State::complete)
    for (const HashedFile& one : files_) sync_file(file(one.path));
  list_.write(file(list_name), list);
  listed_ = true;
  for (const std::string& name : remove_unlisted(partial_, list))
    warnings.push_back(path_ + "/" + name + " cannot be removed and is no part of the result");
  if (const auto old = put_at(partial_, path_, may_replace)) {
    if (!old->empty())
      for (std::string& sentence : dissolve(*old, path_)) warnings.push_back(std::move(sentence));
  } else {
    warnings.push_back(path_ + (state() == State::foreign ? " is not a " : " is a finished ") +
                       kind_ + " and is not replaced; the result of this run is in " + partial_);
    path_ = partial_;
  }
  list_.release();
  for (std::string& warning : warnings)
    for (std::size_t at = warning.find(partial_); at != std::string::npos;
         at = warning.find(partial_, at + path_.size()))
      warning.replace(at, partial_.size(), path_);
  return warnings;
}

}  // namespace palpate
