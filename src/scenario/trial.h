// Makes cases one after the other, and gathers what they read and what is wrong with them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/field_reader.h"
#include "scenario/family.h"

namespace palpate::scenario {

// A case as far as it could be made.
struct Made {
  Case one;          // without a name
  Scenario as_read;  // before materials filled it in
  Reading reading;
  std::vector<Problem> together;  // of keys that do not go together, where each reads well
};

// The document with these settings, read, filled in and checked.
[[nodiscard]] Made make(const Family& family, const std::vector<Setting>& settings,
                        Sources& sources);

// The name of case i.
[[nodiscard]] std::string case_name(const Family& family, std::size_t i,
                                    const std::vector<std::pair<std::string, std::string>>& swept);

// Whether Poisson's ratio reaches the contact and nothing else, and that as a sentence.
[[nodiscard]] bool poisson_in_contact_only(const Scenario& scenario);
extern const char* const poisson_in_contact_only_text;

class Trial {
 public:
  explicit Trial(Family& family) : family_(family) {}

  // Files among the family's inputs; two of one name are a problem.
  void remember(const std::vector<Sources::ReadFile>& read);

  // Case i; the first one made is the family's base.
  Case make(std::size_t i);

  // All cases of a small family, of a large one 256 between the first and the last, and of a table
  // each row that names another file.
  void try_cases();

  // Names that figures and results look cases up by.
  void check_names(const Place& sweep);

  // Every value of a list and both ends of a range, the other factors as in the first case: within
  // the key's limits, and different from each other; and each key is read by one case at least.
  void check_factors();

  // Throws InputError with all problems.
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
  std::map<std::string, std::string> rows_;  // of lists and tables: words by what was read
  std::vector<Problem> problems_;
  std::map<std::string, std::string> unread_;  // swept keys that no case has read, and where they
                                               // would be
  std::map<std::string, bool> read_;           // swept keys that some case has read
  bool contact_only_ = false;                  // some case has springs with a ratio of their own
};

}  // namespace palpate::scenario
