// The emulator's input files: TOML tables whose quantities carry units, unknown keys refused.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace emulator {

// Input that is refused: one sentence with its place. The program ends with code 2.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// One value of a file, whatever reads the file.
struct Node {
  enum class Kind { text, number, flag, list, table };
  Kind kind = Kind::table;
  std::string text = {};
  double number = 0.0;
  bool flag = false;
  std::vector<Node> items = {};                            // of a list
  std::vector<std::pair<std::string, Node>> entries = {};  // of a table, in the file's order
  int line = 0;
  int column = 0;
};

struct Document {
  std::string path;
  Node root;
};

// Reads a TOML file. Throws `Refused` where there is none or where it is no TOML.
[[nodiscard]] Document read_toml(const std::string& path);

// What a text with a unit may mean: "20 mm" is a length, SI inside.
enum class Quantity {
  time,
  length,
  speed,
  acceleration,
  force,
  pressure,
  mass,
  stiffness,
  damping
};

// A quantity's SI value. Throws `Refused` with `place` in front.
[[nodiscard]] double parse_quantity(std::string_view text, Quantity quantity,
                                    const std::string& place);

// The keys of one table; what was never asked for is refused by `finish`.
class Table {
 public:
  Table(const Document& document, const Node& node) : document_(&document), node_(&node) {}

  [[nodiscard]] bool has(const std::string& key) const;
  [[nodiscard]] double quantity(const std::string& key, double otherwise, Quantity quantity);
  [[nodiscard]] double number(const std::string& key, double otherwise);
  [[nodiscard]] std::int64_t count(const std::string& key, std::int64_t otherwise);
  [[nodiscard]] bool flag(const std::string& key, std::string_view otherwise);
  [[nodiscard]] std::string text(const std::string& key, const std::string& otherwise);
  [[nodiscard]] std::string choice(const std::string& key, const std::string& otherwise,
                                   std::span<const std::string_view> allowed);
  // A list of quantities; empty where the key is missing.
  [[nodiscard]] std::vector<double> quantities(const std::string& key, Quantity quantity);
  [[nodiscard]] std::vector<Table> tables(const std::string& key);  // of [[key]] or [key]
  void finish() const;

  // "file:line:column: `key` "
  [[nodiscard]] std::string place(const std::string& key) const;

 private:
  const Node* find(const std::string& key);

  const Document* document_;
  const Node* node_;
  std::set<std::string> read_ = {};
};

}  // namespace emulator
