// Error types: what is wrong with an input, a mesh, a device or the system, and where.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace palpate {

// A position in an input. `line` and `column` count from 1; 0 means unknown.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;

  bool operator==(const Place&) const = default;
  [[nodiscard]] std::string text() const;  // file:line:column, without the parts that are unknown
};

struct Problem {
  Place place;
  std::string message;  // one sentence with a remedy, without the place

  [[nodiscard]] std::string text() const;
};

// Sorts by file (in the order of first problems), line and column, problems without a line last.
void sort_by_place(std::vector<Problem>& problems);

// Input that cannot be used (exit code 2), with every problem that was found, in order.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  InputError(Place place, std::string message);
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

// Throws an InputError about the call of the program, which is at no place in a file.
[[noreturn]] void refuse(const std::string& sentence);

// A mesh that cannot be made or used (exit code 5).
class MeshError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A mesh that does not agree with what a key of the scenario says of it (exit code 2). Where the
// scenario is known it is thrown on as an InputError at that key.
class KeyError : public MeshError {
 public:
  KeyError(std::string key, const std::string& message)
      : MeshError(message), key_(std::move(key)) {}
  [[nodiscard]] const std::string& key() const { return key_; }

 private:
  std::string key_;  // a dotted path
};

// A device that cannot be reached, sends data that cannot be read, or is not safe (exit code 6).
class LinkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// An operation of the system that failed: a full disk, a folder without permission (exit code 1).
class SystemError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate
