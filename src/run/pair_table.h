// What one vertex of the skin does per newton on another, kept as long as the mesh answers alike.
#pragma once

#include <algorithm>
#include <vector>

#include "base/vec3.h"

namespace palpate::run {

// How a read vertex moves by a newton on a pressed one, less what is known of it besides, m/N.
struct PairBlock {
  Eigen::Matrix3d moved = Eigen::Matrix3d::Zero();
  double known = 0.0;  // were both normals one
};

// Blocks that have been asked for, and their parts along two normals as long as these stand.
class PairTable {
 public:
  // Values are asked for along the normals of the contact that is read and of the one that
  // presses: n . moved m - (n . m) known, whatever `known` depends on being `key`. What was kept
  // under another key is forgotten.
  void look(const Vec3& read, const Vec3& pressed, double key) {
    if (key != key_) forget();
    key_ = key;
    if (read == read_ && pressed == pressed_) return;
    ++turn_;
    read_ = read;
    pressed_ = pressed;
    aligned_ = read.dot(pressed);
  }

  // fill() gives the pair's PairBlock where it is not known yet.
  template <class Fill>
  [[nodiscard]] double at(int read, int pressed, const Fill& fill) {
    const std::size_t row = place(read, rows_);
    const std::size_t column = place(pressed, columns_);
    if (row >= capacity_ || column >= capacity_) {
      grow();
      return at(read, pressed, fill);
    }
    Entry& entry = entries_[row * capacity_ + column];
    if (entry.turn == turn_) return entry.along;
    if (entry.turn == 0) entry.block = fill();
    entry.turn = turn_;
    entry.along = read_.dot(entry.block.moved * pressed_) - aligned_ * entry.block.known;
    return entry.along;
  }

  void forget() {
    // What was never asked for is as it was.
    const std::size_t width = std::min(capacity_, static_cast<std::size_t>(columns_.used));
    for (std::size_t row = 0; row < capacity_ && row < static_cast<std::size_t>(rows_.used); ++row)
      std::fill_n(&entries_[row * capacity_], width, Entry{});
    for (Places* places : {&rows_, &columns_}) {
      std::fill(places->of.begin(), places->of.end(), 0);
      places->used = 0;
    }
    turn_ = 1;
  }

  // All the room that it ever takes, for vertices below `vertices`.
  void make_room(std::size_t vertices) {
    while (capacity_ < most) grow();
    for (Places* places : {&rows_, &columns_})
      if (places->of.size() < vertices) places->of.resize(vertices, 0);
  }

 private:
  static constexpr std::size_t most = 256;
  struct Entry {
    PairBlock block;
    double along = 0.0;
    unsigned turn = 0;  // of `along`; 0: nothing is known
  };
  struct Places {
    std::vector<int> of;  // one a vertex; 0: none, else counted from 1
    int used = 0;
  };

  static std::size_t place(int vertex, Places& places) {
    const auto v = static_cast<std::size_t>(vertex);
    if (v >= places.of.size()) places.of.resize(v + 1, 0);
    if (places.of[v] == 0) places.of[v] = ++places.used;
    return static_cast<std::size_t>(places.of[v] - 1);
  }

  // Twice the room; all is asked for anew. Beyond that many vertices the contact has moved far,
  // and those it came from are of no use.
  void grow() {
    forget();
    if (capacity_ == most) return;
    capacity_ = capacity_ == 0 ? 32 : std::min(most, 2 * capacity_);
    entries_.assign(capacity_ * capacity_, {});
  }

  Vec3 read_ = Vec3::Zero();
  Vec3 pressed_ = Vec3::Zero();
  double aligned_ = 0.0;
  double key_ = -1.0;
  std::size_t capacity_ = 0;
  std::vector<Entry> entries_;
  Places rows_;
  Places columns_;
  unsigned turn_ = 1;
};

}  // namespace palpate::run
