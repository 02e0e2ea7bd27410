// Stored compliances between pairs of skin vertices, valid until the mesh's stiffness changes.
#pragma once

#include <algorithm>
#include <vector>

#include "base/vec3.h"

namespace palpate::mechanics {

// Displacements of a read vertex per newton on a pressed vertex (m/N, one column per axis of the
// load), and their components along two normals as long as these normals do not change.
class PairTable {
 public:
  // Sets the normals for at(): n = `read` of the contact whose sinking is computed, m = `pressed`
  // of the contact that presses.
  void look(const Vec3& read, const Vec3& pressed) {
    if (read == read_ && pressed == pressed_) return;
    ++turn_;
    read_ = read;
    pressed_ = pressed;
  }

  // n . block m, m/N. fill() computes the pair's block if it is not stored yet.
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
    entry.along = read_.dot(entry.block * pressed_);
    return entry.along;
  }

  void forget() {
    // Only rows and columns in use need to be cleared.
    const std::size_t width = std::min(capacity_, as_index(columns_.used));
    for (std::size_t row = 0; row < capacity_ && row < as_index(rows_.used); ++row)
      std::fill_n(&entries_[row * capacity_], width, Entry{});
    for (Places* places : {&rows_, &columns_}) {
      std::fill(places->of.begin(), places->of.end(), 0);
      places->used = 0;
    }
    turn_ = 1;
  }

  // Allocates all memory that the table can ever need for vertex numbers below `vertices`.
  void make_room(std::size_t vertices) {
    while (capacity_ < most) grow();
    for (Places* places : {&rows_, &columns_})
      if (places->of.size() < vertices) places->of.resize(vertices, 0);
  }

 private:
  static constexpr std::size_t most = 256;
  struct Entry {
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    double along = 0.0;
    unsigned turn = 0;  // value of turn_ for which `along` was computed; 0: `block` is not known
  };
  struct Places {
    std::vector<int> of;  // one per vertex: its row or column, counted from 1; 0: none
    int used = 0;
  };

  static std::size_t place(int vertex, Places& places) {
    const auto v = as_index(vertex);
    if (v >= places.of.size()) places.of.resize(v + 1, 0);
    if (places.of[v] == 0) places.of[v] = ++places.used;
    return as_index(places.of[v] - 1);
  }

  // Doubles the size, up to `most`, and drops all blocks. A full table means that the contact has
  // moved far, so that the blocks of vertices behind it are no longer needed.
  void grow() {
    forget();
    if (capacity_ == most) return;
    capacity_ = capacity_ == 0 ? 32 : std::min(most, 2 * capacity_);
    entries_.assign(capacity_ * capacity_, {});
  }

  Vec3 read_ = Vec3::Zero();
  Vec3 pressed_ = Vec3::Zero();
  std::size_t capacity_ = 0;
  std::vector<Entry> entries_;
  Places rows_;
  Places columns_;
  unsigned turn_ = 1;
};

}  // namespace palpate::mechanics
