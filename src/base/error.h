// What can be wrong with what we were given, and where.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace palpate {

// A position in an input. `line` and `column` count from 1; 0 means the whole input.
struct Place {
  std::string file;
  int line = 0;
  int column = 0;

  bool operator==(const Place&) const = default;
  [[nodiscard]] std::string text() const;  // file:line:column, as far as known
};

struct Problem {
  Place place;
  std::string message;  // one sentence with a remedy, without the place

  [[nodiscard]] std::string text() const;
};

// The order of a person who mends a file from its top; problems without a line come last.
void sort_by_place(std::vector<Problem>& problems);

// Input that cannot be used (exit code 2). Carries every problem that was found, in order.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  InputError(Place place, std::string message);
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

// A mesh that cannot be made or used (exit code 5).
class MeshError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A device that cannot be reached, understood or trusted (exit code 6).
class LinkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A file or program of the system that failed: a full disk, a folder without permission (exit 1).
class SystemError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate
