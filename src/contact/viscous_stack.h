// The stored rings of a viscoelastic contact, and the decay of their values.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace palpate::contact {

// A stack of rings. A ring has a level (m), the elastic force at that level (N), and values that
// have decayed since it was pushed: value j with rate j % rates. The cost of a time step does not
// depend on the number of rings, because only the age of the top ring is stored and, for each ring,
// how much older the one below it is. Memory is allocated at construction only. When the stack is
// full, rings are removed where they are closest; levels are monotonic from the bottom to the top.
class FadingStack {
 public:
  // `rates` exponential rates with `values` >= 0 values each, and room for `capacity` >= 8 rings.
  FadingStack(std::size_t rates, std::size_t values, std::size_t capacity);

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }

  // A time step in which rate k decays by the factor keep[k]; value_before() refers to its start.
  void fade(std::span<const double> keep);

  // The top ring.
  [[nodiscard]] double level() const { return heads_[size_ - 1].level; }
  [[nodiscard]] double elastic_force() const { return heads_[size_ - 1].elastic_force; }
  [[nodiscard]] double value(std::size_t j) const;
  [[nodiscard]] double value_before(std::size_t j) const;
  // The ring below the top ring; the stack must have two.
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
  std::vector<double> values_;  // [ring][value], when they were pushed
  std::vector<double> links_;   // [ring][rate]: decay of the ring below until this one was pushed
  std::vector<double> age_;     // [rate]: decay of the top ring until now
  std::vector<double> age_before_;  // [rate]: until the start of the step
};

}  // namespace palpate::contact
