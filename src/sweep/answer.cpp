// Sums up the rows of a sweep.
#include "sweep/answer.h"

#include <algorithm>

#include "base/text.h"

namespace palpate::sweep {
namespace {

constexpr std::string_view begins = "Neglected: ", also = " Also neglected: ";

bool in_number(char c) { return is_digit(c) || c == '.'; }

std::string without_numbers(std::string sentence) {
  std::erase_if(sentence, in_number);
  return sentence;
}

// The first number of a sentence, which is the change by an effect; 0 without a number.
double first_number(const std::string& sentence) {
  const std::size_t at = sentence.find_first_of("0123456789");
  if (at == std::string::npos) return 0.0;
  const auto number = leading_number(std::string_view(sentence).substr(at));
  return number ? number->value : 0.0;
}

std::string of_cases(std::size_t count, std::size_t all) {
  return std::to_string(count) + " of " + std::to_string(all) + (all == 1 ? " case" : " cases");
}

}  // namespace

void SweepAnswer::see(const SweepRow& row, std::size_t number) {
  if (row.outcome != SweepOutcome::completed) return;
  ++cases_;
  const double* error = nullptr;
  for (const record::Finding& value : row.values) {
    if (value.name == "model")
      if (const auto* word = std::get_if<std::string>(&value.value)) ++models_[*word];
    if (value.name == "stated_error") error = std::get_if<double>(&value.value);
  }
  if (error == nullptr) {
    ++unknown_;
  } else {
    errors_.low = std::min(errors_.low, *error);
    errors_.high = std::max(errors_.high, *error);
  }
  for (const std::string& warning : row.warnings) {
    if (warning.starts_with(not_counted)) {
      ++uncounted_cases_;
      if (warning.size() > uncounted_.size()) uncounted_ = warning;
    }
    if (!warning.starts_with(begins)) continue;
    std::size_t from = begins.size();
    for (std::size_t end = 0; end != std::string::npos; from = end + also.size()) {
      end = warning.find(also, from);
      see_effect(warning.substr(from, end - from), number);
    }
  }
}

void SweepAnswer::see_effect(const std::string& sentence, std::size_t number) {
  const std::string bare = without_numbers(sentence);
  auto effect = std::find_if(effects_.begin(), effects_.end(),
                             [&](const Effect& one) { return one.bare == bare; });
  if (effect == effects_.end()) effect = effects_.insert(effects_.end(), Effect{.bare = bare});
  const double change = first_number(sentence);
  if (effect->cases++ > 0 && change <= effect->largest) return;
  effect->largest = change;
  effect->sentence = sentence;
  effect->number = number;
}

std::string SweepAnswer::error() const {
  if (cases_ == 0) return {};
  if (unknown_ == cases_) return "error not known";
  const auto text = [](double error) {
    return error > 1.0 ? std::string("more than 100 %") : percent_text(error);
  };
  const std::string low = text(errors_.low), high = text(errors_.high);
  return "± " + low + (low == high ? "" : " to " + high) +
         (tolerance.empty() ? "" : " (tolerance " + tolerance + ")") +
         (unknown_ == 0 ? "" : ", not known in " + of_cases(unknown_, cases_)) +
         (uncounted_cases_ == 0 ? ""
          : uncounted_cases_ == cases_
              ? ", " + uncounted_
              : ", " + uncounted_ + " in " + of_cases(uncounted_cases_, cases_));
}

std::vector<std::string> SweepAnswer::lines() const {
  if (cases_ == 0) return {};
  std::string models;
  for (const auto& [model, count] : models_)
    models += (models.empty() ? "Model: " : ", ") + model + " in " + of_cases(count, cases_);
  std::vector<std::string> lines;
  if (!models.empty()) lines.push_back(models + ".");
  std::vector<Effect> effects = effects_;
  std::stable_sort(effects.begin(), effects.end(),
                   [](const Effect& a, const Effect& b) { return a.largest > b.largest; });
  for (const Effect& one : effects) {
    std::string line = "Neglected in " + of_cases(one.cases, cases_);
    if (one.cases > 1) line += ", most in case " + std::to_string(one.number);
    lines.push_back(line + ": " + one.sentence);
  }
  if (effects.empty())
    lines.emplace_back(
        "Neglected: nothing that would add more than a fifth of `solver.tolerance` to the error.");
  return lines;
}

}  // namespace palpate::sweep
