// LINK texts: the word of a kind, a colon, and the address; links, each opened by its address; and
// recordings. This room may not include `measured`, and reads CSV by itself.
#include "device/link.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "device/inverse3.h"
#include "device/line_gauge.h"
#include "device/mark10.h"

namespace palpate::device {
namespace {

struct Columns {
  int time = -1;
  int position[3] = {-1, -1, -1};
  int travel = -1;
  int force = -1;
};

Columns columns_of(const std::vector<std::string>& header, const std::string& file) {
  const auto find = [&](std::string_view name) {
    const auto at = std::ranges::find(header, name);
    return at == header.end() ? -1 : static_cast<int>(at - header.begin());
  };
  Columns columns;
  columns.time = find("time_s");
  columns.position[0] = find("position_x_m");
  columns.position[1] = find("position_y_m");
  columns.position[2] = find("position_z_m");
  // The file of a live run has the model's travel and force as well.
  columns.travel = find("measured_travel_mm");
  if (columns.travel < 0) columns.travel = find("travel_mm");
  columns.force = find("measured_force_N");
  if (columns.force < 0) columns.force = find("force_N");
  const bool whole = *std::min_element(columns.position, columns.position + 3) >= 0;
  if (columns.time < 0)
    throw InputError({file, 1, 0},
                     "a recording wants a column `time_s`; give the column of times this name");
  if (!whole && columns.travel < 0)
    throw InputError({file, 1, 0},
                     "a recording wants a position; name it `travel_mm`, or `position_x_m`, "
                     "`position_y_m` and `position_z_m`");
  if (!whole) columns.position[0] = columns.position[1] = columns.position[2] = -1;
  return columns;
}

}  // namespace

std::vector<Sample> parse_recording(std::string_view text, const std::string& file) {
  const std::vector<std::string> lines = split(text, '\n');
  const auto fields_of = [&](const std::string& line) {
    std::vector<std::string> fields = split(line, ',');
    for (std::string& field : fields) field = trimmed(field);
    return fields;
  };
  const Columns columns = columns_of(fields_of(lines.front()), file);
  const std::size_t width = fields_of(lines.front()).size();
  std::vector<Sample> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (trimmed(lines[i]).empty()) continue;
    const Place place{file, static_cast<int>(i) + 1, 0};
    const std::vector<std::string> fields = fields_of(lines[i]);
    if (fields.size() != width)
      throw InputError(place, "the row has " + std::to_string(fields.size()) +
                                  " fields, the header " + std::to_string(width) +
                                  "; give every row one field per column");
    const auto number = [&](int column) {
      const auto value = whole_number(fields[as_index(column)]);
      if (!value || !std::isfinite(*value))
        throw InputError(
            place, "`" + fields[as_index(column)] + "` is no finite number; leave such rows out");
      return *value;
    };
    Sample row;
    row.arrival = Arrival::fresh;
    row.device_time = number(columns.time);
    if (columns.position[0] >= 0) {
      for (int axis = 0; axis < 3; ++axis) row.position[axis] = number(columns.position[axis]);
    } else {
      row.position.z() = -1e-3 * number(columns.travel);
    }
    if (columns.force >= 0 && !fields[as_index(columns.force)].empty())
      row.force = number(columns.force);
    if (!rows.empty()) {
      const double dt = row.device_time - rows.back().device_time;
      if (dt < 0.0) throw InputError(place, "`time_s` goes back; sort the rows by time");
      if (dt > 0.0) row.velocity = (row.position - rows.back().position) / dt;
    }
    rows.push_back(row);
  }
  if (rows.empty()) throw InputError({file, 0, 0}, "the recording has no rows; record some");
  return rows;
}

Recording::Recording(const std::string& file, Clock& clock)
    : LinkParts(clock), rows_(parse_recording(read_text(file), file)) {
  identity_.kind = Kind::recording;
  identity_.id = file;
  identity_.dialect = "csv";
  limits_.measures_force = std::isfinite(rows_.front().force);
  const double span = rows_.back().device_time - rows_.front().device_time;
  limits_.period = rows_.size() > 1 ? span / static_cast<double>(rows_.size() - 1) : 0.0;
  double longest = 0.0;
  for (std::size_t i = 1; i < rows_.size(); ++i)
    longest = std::max(longest, rows_[i].device_time - rows_[i - 1].device_time);
  // Gaps that the recording contains do not count as a stale link.
  limits_.stale_after = std::max(3.0 * limits_.period, 1.5 * longest);
  limits_.lost_after = std::max(0.1, 2.0 * limits_.stale_after);
}

Sample Recording::sample(double wait) {
  if (next_ == rows_.size()) return finished(Arrival::lost, Fault::recording_ended);
  if (next_ == 0) start_ = clock_.now() - rows_.front().device_time;
  const double due = start_ + rows_[next_].device_time;
  const double until = clock_.now() + std::max(0.0, wait);
  if (due > until) {
    if (wait > 0.0) clock_.sleep_until(until);
    return finished(Arrival::none, Fault::none);
  }
  if (due > clock_.now()) clock_.sleep_until(due);
  Sample row = rows_[next_++];
  row.received = clock_.now();
  ++traffic_.received;
  return row;
}

struct Link::Variant {
  std::variant<Mark10, LineGauge, Inverse3, Recording> link;

  template <class Kind, class... Arguments>
  explicit Variant(std::in_place_type_t<Kind> kind, Arguments&&... arguments)
      : link(kind, std::forward<Arguments>(arguments)...) {}

  static std::unique_ptr<Variant> open(const StandAddress& address, Purpose purpose, Clock& clock,
                                       Tap* tap) {
    return std::make_unique<Variant>(std::in_place_type<Mark10>, address.port, purpose, clock, tap);
  }
  static std::unique_ptr<Variant> open(const GaugeAddress& address, Purpose, Clock& clock,
                                       Tap* tap) {
    return std::make_unique<Variant>(std::in_place_type<LineGauge>, address, clock, tap);
  }
  static std::unique_ptr<Variant> open(const ArmAddress& address, Purpose purpose, Clock& clock,
                                       Tap* tap) {
    return std::make_unique<Variant>(std::in_place_type<Inverse3>, address, purpose, clock, tap);
  }
  static std::unique_ptr<Variant> open(const RecordingAddress& address, Purpose, Clock& clock,
                                       Tap*) {
    return std::make_unique<Variant>(std::in_place_type<Recording>, address.file, clock);
  }

  template <class Use>
  decltype(auto) with(const Use& use) {
    return std::visit(use, link);
  }
};

Link::Link(std::string_view text, Purpose purpose, Clock& clock, Tap* tap)
    : link_(std::visit(
          [&](const auto& address) { return Variant::open(address, purpose, clock, tap); },
          parse_link(text))) {}

Link::~Link() = default;
Link::Link(Link&&) noexcept = default;

const Identity& Link::identity() const {
  return link_->with([](auto& link) -> const Identity& { return link.identity(); });
}
const Limits& Link::limits() const {
  return link_->with([](auto& link) -> const Limits& { return link.limits(); });
}
Traffic Link::traffic() const {
  return link_->with([](auto& link) { return link.traffic(); });
}
Sample Link::sample(double wait) {
  return link_->with([&](auto& link) { return link.sample(wait); });
}

// Only the arm accepts forces, and only the stand accepts motions.
Fault Link::command_force(const Vec3& force) {
  auto* arm = std::get_if<Inverse3>(&link_->link);
  return arm != nullptr ? arm->command_force(force) : Fault::refused;
}
Fault Link::set_travel_limits(double low, double high) {
  auto* stand = std::get_if<Mark10>(&link_->link);
  return stand != nullptr ? stand->set_travel_limits(low, high) : Fault::refused;
}
Fault Link::command_motion(const Motion& motion) {
  auto* stand = std::get_if<Mark10>(&link_->link);
  return stand != nullptr ? stand->move(motion) : Fault::refused;
}

std::vector<std::string> Link::heard() const {
  const auto* gauge = std::get_if<LineGauge>(&link_->link);
  return gauge != nullptr ? gauge->heard() : std::vector<std::string>();
}

bool Link::stop() {
  return link_->with([](auto& link) { return link.stop(); });
}

namespace {

struct LinkKind {
  const char* word;                                                  // before the colon
  const char* form;                                                  // for help texts
  const char* example;                                               // for errors
  Address (*address)(std::string_view text, std::string_view rest);  // `rest` follows the colon
};
Address stand_address(std::string_view text, std::string_view rest);
Address gauge_address(std::string_view text, std::string_view rest);
Address arm_address(std::string_view text, std::string_view rest);
Address recording_address(std::string_view text, std::string_view rest);

// In the order of Address.
constexpr std::array kinds{
    LinkKind{"mark10", "mark10:PORT", "mark10:/dev/ttyUSB0", stand_address},
    LinkKind{"serial", "serial:PORT,SETTINGS.toml", "serial:/dev/ttyACM0,gauge.toml",
             gauge_address},
    LinkKind{"inverse3", "inverse3:HOST:PORT[:EVENTS][/ID]", "inverse3:localhost:10001",
             arm_address},
    LinkKind{"replay", "replay:FILE.csv", "replay:FILE.csv", recording_address}};
static_assert(kinds.size() == std::variant_size_v<Address>, "a link lacks its text");

// "A, B or C", with the member `text` of every kind.
std::string listed(const char* LinkKind::*text, const std::string& quote) {
  std::vector<std::string> list;
  for (const LinkKind& kind : kinds) list.push_back(quote + kind.*text + quote);
  return alternatives(list);
}

[[noreturn]] void refuse(std::string_view text, const std::string& why) {
  throw InputError({}, "palpate: the link `" + std::string(text) + "` " + why + "; write it as " +
                           listed(&LinkKind::example, "`"));
}

std::optional<int> port_number(std::string_view text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (port < 1 || port > 65535) return std::nullopt;
  return port;
}

int wanted_port(std::string_view text, std::string_view word, const char* what) {
  const auto port = port_number(word);
  if (!port) refuse(text, what);
  return *port;
}

Address stand_address(std::string_view text, std::string_view rest) {
  if (rest.empty()) refuse(text, "names no serial port");
  return StandAddress{std::string(rest)};
}

// The file of the settings follows the last comma, which a port's path may have as well.
Address gauge_address(std::string_view text, std::string_view rest) {
  const auto comma = rest.rfind(',');
  if (comma == std::string_view::npos || comma + 1 == rest.size())
    refuse(text, "names no file of settings after a comma");
  if (comma == 0) refuse(text, "names no serial port");
  return GaugeAddress{std::string(rest.substr(0, comma)), std::string(rest.substr(comma + 1))};
}

Address recording_address(std::string_view text, std::string_view rest) {
  if (rest.empty()) refuse(text, "names no file");
  return RecordingAddress{std::string(rest)};
}

// HOST:PORT[:EVENTS][/ID]; a host that contains colons (IPv6) is written in brackets.
Address arm_address(std::string_view text, std::string_view rest) {
  const bool bracketed = rest.starts_with('[');
  if (bracketed) rest.remove_prefix(1);
  const std::string_view host = rest.substr(0, rest.find(bracketed ? ']' : ':'));
  std::string_view ports = rest.substr(host.size());
  if (bracketed && ports.starts_with(']')) ports.remove_prefix(1);
  if (!ports.starts_with(':')) refuse(text, "lacks a port");
  ports.remove_prefix(1);
  const auto slash = ports.find('/');
  std::string id;
  if (slash != std::string_view::npos) {
    id = ports.substr(slash + 1);
    ports = ports.substr(0, slash);
    if (id.empty()) refuse(text, "wants the id of an arm after `/`");
  }
  if (host.empty()) refuse(text, "lacks a host");
  ArmAddress address{.host = std::string(host), .id = id};
  const auto colon = ports.find(':');
  address.port = wanted_port(text, ports.substr(0, colon), "wants a port from 1 to 65535");
  if (colon == std::string_view::npos) return address;
  const std::string_view events = ports.substr(colon + 1);
  address.events = std::nullopt;
  if (events != "none")
    address.events =
        wanted_port(text, events, "wants, for the events, a port from 1 to 65535 or `none`");
  return address;
}

}  // namespace

Address parse_link(std::string_view text) {
  const auto colon = text.find(':');
  const std::string word(text.substr(0, colon));
  const std::string_view rest =
      colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1);
  if (text.find('\0') != std::string_view::npos) refuse(word, "holds a zero byte");
  std::vector<std::string> words;
  for (const LinkKind& kind : kinds) {
    if (word == kind.word) return kind.address(text, rest);
    words.emplace_back(kind.word);
  }
  const auto near = nearest(word, words);
  refuse(text, "begins with no known kind" + (near ? ", did you mean `" + *near + ":`" : ""));
}

bool only_reads(const Address& address) {
  return std::holds_alternative<GaugeAddress>(address) ||
         std::holds_alternative<RecordingAddress>(address);
}

std::string link_forms() { return listed(&LinkKind::form, ""); }

}  // namespace palpate::device
