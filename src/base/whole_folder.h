// A result folder that is either complete or absent: it is written beside its place and renamed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"

namespace palpate {

// What a command may replace: results of interrupted runs and unchanged results of the same origin,
// or all complete ones too (`--force`).
enum class Replace { incomplete, any };

// Whether the file exists and has exactly this content: it need not be replaced then.
[[nodiscard]] bool holds(const std::string& path, std::string_view content);

// Files are written into the partial folder PLACE.partial-PID. put() lists them with their hashes
// in the file `contents.sha256` and exchanges the folder with the one at PLACE. In the old folder
// it deletes the files that are listed there and unchanged since; all other files are moved into
// the new folder. A running process keeps its list locked, so that other processes can tell which
// partial folders are abandoned.
class WholeFolder {
 public:
  enum class State {
    free,        // nothing is there, or an empty folder
    incomplete,  // a result of an interrupted run
    complete,
    foreign  // anything without a list of this kind
  };

  // `kind` is a noun for the list and for messages, such as `result`. The constructor clears up
  // what killed processes left for this place: it completes an exchange that was begun and removes
  // partial folders that contain nothing to keep. `origin` is a fingerprint of the result, equal
  // for two commands that give the same one; empty if no other command can.
  WholeFolder(const std::string& place, std::string kind, Replace replace,
              const std::string& origin = {});
  // Removes the partial folder unless it was put in place or contains a file to keep.
  ~WholeFolder();
  WholeFolder(const WholeFolder&) = delete;
  WholeFolder& operator=(const WholeFolder&) = delete;

  // The state of what is at the place now.
  [[nodiscard]] State state() const;
  // Throws InputError if there is something at the place that may not be replaced.
  void refuse_what_is_there() const;

  // Creates the partial folder and the folders above it. Throws SystemError.
  void open();
  // The partial folder, and the path of a file in it.
  [[nodiscard]] const std::string& partial() const { return partial_; }
  [[nodiscard]] std::string file(const std::string& name) const { return partial_ + "/" + name; }
  // Writes a file of the result, which put() waits for; `hash` is its sha256() where that is known.
  // Throws SystemError.
  void write(const std::string& name, std::string_view content, std::string hash = {});
  // Adds existing files of the partial folder to the list. Throws InputError if one is missing.
  void add(const std::vector<std::string>& names);
  [[nodiscard]] const std::vector<HashedFile>& files() const { return files_; }
  // From now on, if a file or folder of this name exists in it, the partial folder stays even if
  // the program is killed before put(). Throws SystemError.
  void keep(const std::string& name);
  // The partial folder if it would stay now for what is kept in it; else empty.
  [[nodiscard]] std::string kept() const;

  // Moves the folder to its place, as `complete` or `incomplete`. If there is something at the
  // place that may not be replaced (an incomplete result never replaces a complete one), the folder
  // stays beside it and a warning says so. Returns `warnings`, in which the paths of files are
  // updated, and its own warnings. Throws SystemError.
  [[nodiscard]] std::vector<std::string> put(State content, std::vector<std::string> warnings = {});

  // Where the result is, or will be.
  [[nodiscard]] const std::string& path() const { return path_; }
  // Partial folders for this place that other processes have left or are still writing, sorted.
  [[nodiscard]] std::vector<std::string> left_beside() const;

 private:
  void clear_up() const;
  // Whether the folder holds a complete result of the same origin.
  [[nodiscard]] bool has_same_origin(const std::string& folder) const;

  std::string path_;
  std::string kind_;
  Replace replace_;
  std::string origin_line_;  // of the list; empty without an origin
  std::string partial_;
  HeldFile list_;
  std::string to_keep_;  // content of the list until put()
  std::vector<HashedFile> files_;
  bool opened_ = false;
  bool listed_ = false;
};

}  // namespace palpate
