// Reads tolerances from TOML and reports all problems at once.
#include "compare/tolerances.h"

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "base/document.h"
#include "base/error.h"
#include "base/text.h"

namespace palpate::compare {
namespace {

const std::vector<std::string>& tables() {
  static const std::vector<std::string> names{"default", "column", "tube"};
  return names;
}
const std::vector<std::string>& keys() {
  static const std::vector<std::string> names{"rel", "abs", "ignore", "reason"};
  return names;
}
const std::vector<std::string>& tube_keys() {
  static const std::vector<std::string> names{"x", "width"};
  return names;
}

std::string unknown(const std::string& key, std::span<const std::string> known) {
  const std::string message = "`" + key + "` is not known here";
  if (const auto near = nearest(key, known)) return message + "; did you mean `" + *near + "`?";
  return message + "; write one of `" + joined(known, "`, `") + "`";
}

std::string wants(const std::string& key, const std::string& what, const Node& got,
                  const std::string& remedy) {
  return "`" + key + "` wants " + what + ", got `" + got.shown() + "`; write it as `" + remedy +
         "`";
}

class Reader {
 public:
  void read(const Node& root, Tolerances& tolerances) {
    if (const Member* standard = root.find("default")) table(*standard, tolerances.standard);
    for (const Member& member : root.members) {
      if (member.key == "default") continue;
      if (member.key == "tube") {
        tube(member, tolerances.tube.emplace());
        if (const Member* x = member.value.find("x"))
          tolerances.places.emplace_back(tolerances.tube->x, x->value.place);
        continue;
      }
      if (member.key != "column") {
        report(member.place, unknown(member.key, tables()));
      } else if (member.value.kind != Node::Kind::table) {
        report(member.value.place, "`column` wants tables, as `[column.force_N]`");
      } else {
        for (const Member& column : member.value.members) {
          Tolerance tolerance = tolerances.standard;
          tolerance.reason.clear();
          table(column, tolerance);
          tolerances.columns[column.key] = tolerance;
          tolerances.places.emplace_back(column.key, column.place);
        }
      }
    }
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  void table(const Member& from, Tolerance& to) {
    if (from.value.kind != Node::Kind::table)
      return report(from.value.place, "`" + from.key + "` wants a table, got `" +
                                          from.value.shown() + "`; give it keys, as `rel = 1e-9`");
    for (const Member& member : from.value.members) {
      if (member.key == "rel")
        number(member, to.rel, "1e-9");
      else if (member.key == "abs")
        number(member, to.abs, "1e-12");
      else if (member.key == "ignore")
        truth(member, to.ignore);
      else if (member.key == "reason")
        text(member, to.reason, "reason = \"rounding of 1e4 steps\"");
      else
        report(member.place, unknown(member.key, keys()));
    }
  }

  void tube(const Member& from, Tube& to) {
    if (from.value.kind != Node::Kind::table)
      return report(from.value.place, "`tube` wants a table, got `" + from.value.shown() +
                                          "`; write `[tube]` and below it `x` and `width`");
    for (const Member& member : from.value.members) {
      if (member.key == "x")
        text(member, to.x, "x = \"time_s\"");
      else if (member.key == "width")
        number(member, to.width, "0.05");
      else
        report(member.place, unknown(member.key, tube_keys()));
    }
    if (to.x.empty())
      report(from.place, "`tube` wants the name of the column of x; write `x = \"time_s\"`");
    if (from.value.find("width") == nullptr)
      report(from.place, "`tube` wants a width, in the unit of its column; write `width = 0.05`");
  }

  void number(const Member& from, double& to, const std::string& example) {
    const bool good =
        from.value.is_number() && std::isfinite(from.value.number) && from.value.number >= 0.0;
    if (good)
      to = from.value.number;
    else
      report(from.value.place,
             wants(from.key, "a number of 0 or more", from.value, from.key + " = " + example));
  }

  void truth(const Member& from, bool& to) {
    if (from.value.kind == Node::Kind::boolean)
      to = from.value.boolean;
    else
      report(from.value.place, wants(from.key, "true or false", from.value, "ignore = true"));
  }

  void text(const Member& from, std::string& to, const std::string& example) {
    if (from.value.kind == Node::Kind::text)
      to = from.value.text;
    else
      report(from.value.place, wants(from.key, "a text", from.value, example));
  }

  void report(const Place& place, const std::string& message) {
    problems_.push_back({place, message});
  }

  std::vector<Problem> problems_;
};

}  // namespace

const Tolerance& Tolerances::of(const std::string& column) const {
  const auto found = columns.find(column);
  return found == columns.end() ? standard : found->second;
}

Tolerances parse_tolerances(std::string_view text, const std::string& file) {
  Tolerances tolerances;
  Reader().read(parse_toml(text, file), tolerances);
  return tolerances;
}

Tolerances read_tolerances(const std::string& path) {
  Tolerances tolerances;
  Reader().read(read_toml(path), tolerances);
  return tolerances;
}

}  // namespace palpate::compare
