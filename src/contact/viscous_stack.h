// The rings of surface that a viscoelastic contact remembers, and how what they remember fades.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace palpate::contact {

// A stack of rings. A ring carries its level (m), the elastic force there (N), and values each of
// which has faded by itself since the ring was laid down: value j with the rate j % rates. Time
// costs the same however many rings there are, since only the age of the top one is kept and, for
// each ring, how much older the one below it is.
// All memory is taken at construction. A full stack drops rings from where they lie closest; levels
// run monotonically from the bottom to the top.
class FadingStack {
 public:
  // `rates` exponential rates, `values` >= 0 values for each, room for `capacity` >= 8 rings.
  FadingStack(std::size_t rates, std::size_t values, std::size_t capacity);

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }

  // A step of time in which rate k fades by keep[k]; `before` below is what was there before it.
  void fade(std::span<const double> keep);

  // Of the top ring.
  [[nodiscard]] double level() const { return heads_[size_ - 1].level; }
  [[nodiscard]] double elastic_force() const { return heads_[size_ - 1].elastic_force; }
  [[nodiscard]] double value(std::size_t j) const;
  [[nodiscard]] double value_before(std::size_t j) const;
  // Of the ring under it; the stack must hold two.
  [[nodiscard]] double level_below() const { return heads_[size_ - 2].level; }
  [[nodiscard]] double elastic_force_below() const { return heads_[size_ - 2].elastic_force; }

  void push(double level, double elastic_force, std::span<const double> values);
  void pop();

 private:
  struct Head {
    double level = 0.0;          // m
    double elastic_force = 0.0;  // N
  };

  void thin();

  std::size_t rates_, stride_, capacity_;
  std::size_t size_ = 0;
  std::vector<Head> heads_;
  std::vector<double> values_;      // [ring][value], as they were laid down
  std::vector<double> links_;       // [ring][rate]: how far the ring below has faded till this one
  std::vector<double> age_;         // [rate]: how far the top ring has faded till now
  std::vector<double> age_before_;  // and till the step's begin
};

}  // namespace palpate::contact
