// Makes cases one after the other, and collects the files that they read and their problems.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "scenario/family.h"

namespace palpate::scenario {

// A case, as far as it could be made.
struct Made {
  Case one;          // without a name
  Scenario as_read;  // without the values that follow from other keys
  Reading reading;
  std::vector<Problem> together;  // of several keys together, each of which is valid
};

// Reads, completes and checks the document with these settings.
[[nodiscard]] Made make(const Family& family, const std::vector<Setting>& settings,
                        Sources& sources);

// The name of case i.
[[nodiscard]] std::string case_name(const Family& family, std::size_t i,
                                    const std::vector<std::pair<std::string, std::string>>& swept);

// Whether Poisson's ratio affects the contact only, and the text that says so.
[[nodiscard]] bool poisson_in_contact_only(const Scenario& scenario);
extern const char* const poisson_in_contact_only_text;

class Trial {
 public:
  explicit Trial(Family& family) : family_(family) {}

  // Adds files to the family's inputs; two different files with one name are a problem.
  void remember(const std::vector<Sources::ReadFile>& read);

  // Makes case i; the first case made becomes the family's base.
  Case make(std::size_t i);

  // Makes all cases of a family of at most `most`; otherwise that many, evenly spread, and each row
  // of a table that names other files.
  void try_cases(std::size_t most);

  // Checks that case names are different, and that `display_scale` uses existing names.
  void check_names(const Place& sweep);

  // Checks every value of a list and both ends of a range, with the other factors as in the first
  // case: they must be within the key's limits and different from each other. Checks also that
  // every swept key is read by at least one case.
  void check_factors();

  // Throws InputError with all problems, if there are any.
  void finish();

 private:
  Made take(const std::vector<Setting>& settings);
  void refuse_equal(std::map<std::string, std::string>& seen, const Made& made,
                    const std::vector<Setting>& values, const std::string& of);
  void add_problems(const std::vector<Problem>& problems);
  void check_values(std::size_t factor);
  void check_swept_keys();

  Family& family_;
  bool begun_ = false;
  std::map<std::string, std::string> rows_;  // of lists and tables: their words, by the values read
  std::vector<Problem> problems_;
  std::map<std::string, std::string> unread_;  // swept keys that some case ignores, with the
                                               // condition under which they would be read
  std::map<std::string, bool> read_;           // swept keys that some case has read
  bool contact_only_ = false;                  // poisson_in_contact_only() holds for some case
};

}  // namespace palpate::scenario
