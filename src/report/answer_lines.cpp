// Sums up the answers of the cases of a scenario.
#include "report/answer_lines.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "base/text.h"
#include "report/finding_words.h"

namespace palpate::report {
namespace {

std::string without_numbers(std::string sentence) {
  std::erase_if(sentence, [](char c) {
    return std::string_view("0123456789.e+-").find(c) != std::string_view::npos;
  });
  return sentence;
}

// The case with the smallest and that with the largest value of a finding.
struct Range {
  const record::CaseRecord* least = nullptr;
  const record::CaseRecord* most = nullptr;
  double low = 0.0;
  double high = 0.0;
};

// The range over all cases for which `value_of` has a value; nothing if there is none.
template <class ValueOf>
std::optional<Range> range_of(const std::vector<record::CaseRecord>& records,
                              const ValueOf& value_of) {
  Range range;
  for (const record::CaseRecord& record : records) {
    const std::optional<double> value = value_of(record);
    if (!value) continue;
    if (range.least == nullptr || *value < range.low) {
      range.least = &record;
      range.low = *value;
    }
    if (range.most == nullptr || *value > range.high) {
      range.most = &record;
      range.high = *value;
    }
  }
  if (range.least == nullptr) return std::nullopt;
  return range;
}

// "Peak force: 0.1 N (`skin`) to 2 N (`bone`)"
std::string range_text(const std::string& what, const Range& range, const std::string& unit) {
  const auto text = [&](double value, const record::CaseRecord& record) {
    return rounded_text(value, warranted_digits(record.answer)) + unit + " (" +
           ticked(record.name) + ")";
  };
  return what + ": " + text(range.low, *range.least) + " to " + text(range.high, *range.most);
}

std::string models(const std::vector<record::CaseRecord>& records) {
  std::map<std::string, int> counts;
  for (const record::CaseRecord& record : records)
    if (const std::string model = finding_word(record, "model"); !model.empty()) ++counts[model];
  std::string text = "Models: ";
  for (const auto& [model, count] : counts)
    text += (text.ends_with(": ") ? "" : ", ") + model + " in " + std::to_string(count) + " of " +
            std::to_string(records.size());
  return text;
}

// ", not counting viscosity", ", not counting viscosity in 3 of 5 cases".
std::string uncounted(const std::vector<record::CaseRecord>& records) {
  const record::Answer* longest = nullptr;
  std::ptrdiff_t cases = 0;
  for (const record::CaseRecord& record : records) {
    if (record.answer.uncounted.empty()) continue;
    ++cases;
    if (longest == nullptr || record.answer.uncounted.size() > longest->uncounted.size())
      longest = &record.answer;
  }
  if (longest == nullptr) return "";
  return record::uncounted_text(*longest) + (cases == std::ssize(records)
                                                 ? ""
                                                 : " in " + std::to_string(cases) + " of " +
                                                       std::to_string(records.size()) + " cases");
}

// "errors of about 1.2 % to 6.1 % (tolerance 5 %), not counting viscosity"
std::string errors(const std::vector<record::CaseRecord>& records) {
  const auto error = range_of(records, [](const auto& one) { return one.answer.stated_error; });
  if (!error) return "";
  const std::string low = error_text(error->low), high = error_text(error->high);
  std::string text = "errors of " + low;
  if (low != high) text += " to " + (error->high > 1.0 ? high : percent_text(error->high));
  if (const std::string& tolerance = error->most->answer.tolerance; !tolerance.empty())
    text += " (" + tolerance + ")";
  return text + uncounted(records);
}

// The largest force of a case that diverged is none of the tissue's.
std::string peaks(const std::vector<record::CaseRecord>& records) {
  const auto unstable = std::ranges::count_if(records, &record::CaseRecord::unstable);
  const std::string diverged =
      std::to_string(unstable) + " of " + std::to_string(records.size()) + " cases diverged";
  std::string text = unstable > 0 ? diverged : "Nothing was reached";
  if (const auto range = range_of(records, [](const auto& one) {
        const auto peak = one.unstable ? std::nullopt : record::peak_of(one);
        return peak ? std::optional(peak->value) : std::nullopt;
      })) {
    const record::Peak peak = *record::peak_of(*range->most);
    text = (unstable > 0 ? diverged + "; peak " : "Peak ") + range_text(peak.of, *range, peak.unit);
  }
  const std::string with = errors(records);
  return text + (with.empty() ? "" : ", with ") + with + ".";
}

// One line per kind of neglected effect.
void add_neglected(const std::vector<record::CaseRecord>& records,
                   std::vector<std::string>& lines) {
  std::vector<NamedSentence> neglected;
  constexpr std::string_view begins = "Neglected: ";
  for (const record::CaseRecord& record : records)
    if (const std::string& text = record.answer.neglected; !record.answer.effects.empty())
      neglected.push_back({record.name, text.substr(text.starts_with(begins) ? begins.size() : 0)});
  if (neglected.empty())
    lines.push_back(records.front().answer.neglected);
  else
    for (const std::string& line : said_once(neglected)) lines.push_back("Neglected in " + line);
}

}  // namespace

std::vector<std::string> said_once(const std::vector<NamedSentence>& all) {
  struct Kind {
    std::string bare;
    NamedSentence first;
    int cases = 0;
  };
  std::vector<Kind> kinds;
  for (const NamedSentence& one : all) {
    const std::string bare = without_numbers(one.sentence);
    const auto known = std::ranges::find(kinds, bare, &Kind::bare);
    if (known == kinds.end())
      kinds.push_back({bare, one, 1});
    else
      ++known->cases;
  }
  std::vector<std::string> lines;
  for (const Kind& kind : kinds)
    lines.push_back(ticked(kind.first.name) +
                    (kind.cases == 1 ? ""
                                     : ", and so in " + std::to_string(kind.cases - 1) + " more" +
                                           (kind.cases == 2 ? " case" : " cases")) +
                    ": " + kind.first.sentence);
  return lines;
}

std::vector<std::string> answer_lines(const std::vector<record::CaseRecord>& records) {
  if (records.empty()) return {};
  if (records.size() == 1) {
    const record::Answer& answer = records.front().answer;
    if (answer.neglected.empty()) return {answer.model, answer.error};  // no model ran
    return {answer.model, answer.error, answer.neglected};
  }
  std::vector<std::string> lines{models(records) + "; `palpate explain` says why.", peaks(records)};
  add_neglected(records, lines);
  return lines;
}

std::vector<std::string> forecast_lines(const std::vector<record::CaseRecord>& records) {
  std::vector<std::string> lines{models(records) + "."};
  if (const std::string text = errors(records); !text.empty())
    lines.push_back(capitalized(text) + ".");
  add_neglected(records, lines);
  return lines;
}

}  // namespace palpate::report
