// The stack of a viscoelastic contact: all rings decay at the cost of one.
#include "contact/viscous_stack.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpate::contact {

FadingStack::FadingStack(std::size_t rates, std::size_t values, std::size_t capacity)
    : rates_(rates),
      stride_(rates * values),
      capacity_(capacity),
      heads_(capacity),
      values_(capacity * stride_),
      links_(capacity * rates),
      age_(rates, 1.0),
      age_before_(rates, 1.0) {
  assert(capacity >= 8);
}

void FadingStack::fade(std::span<const double> keep) {
  age_before_ = age_;
  for (std::size_t k = 0; k < rates_; ++k) age_[k] *= keep[k];
}

double FadingStack::value(std::size_t j) const {
  return age_[j % rates_] * values_[(size_ - 1) * stride_ + j];
}

double FadingStack::value_before(std::size_t j) const {
  return age_before_[j % rates_] * values_[(size_ - 1) * stride_ + j];
}

void FadingStack::push(double level, double elastic_force, std::span<const double> values) {
  if (size_ == capacity_) thin();
  heads_[size_] = {level, elastic_force};
  for (std::size_t j = 0; j < stride_; ++j) values_[size_ * stride_ + j] = values[j];
  for (std::size_t k = 0; k < rates_; ++k) {
    links_[size_ * rates_ + k] = age_[k];
    age_[k] = age_before_[k] = 1.0;
  }
  ++size_;
}

void FadingStack::pop() {
  --size_;
  for (std::size_t k = 0; k < rates_; ++k) {
    age_[k] *= links_[size_ * rates_ + k];
    age_before_[k] *= links_[size_ * rates_ + k];
  }
}

void FadingStack::thin() {
  // Removes rings closer than about 2/capacity of the height. At most half of them and the two ends
  // stay, so that this happens at most once in about capacity / 2 pushes.
  const double height = std::abs(heads_[size_ - 1].level - heads_[0].level);
  const double spacing = 2.0 * height / static_cast<double>(capacity_ - 4);
  std::size_t kept = 1;
  for (std::size_t i = 1; i < size_; ++i) {
    for (std::size_t k = 0; k < rates_; ++k) links_[kept * rates_ + k] = links_[i * rates_ + k];
    const bool last = i + 1 == size_;
    if (!last && std::abs(heads_[i].level - heads_[kept - 1].level) < spacing) {
      for (std::size_t k = 0; k < rates_; ++k)
        links_[(i + 1) * rates_ + k] *= links_[i * rates_ + k];
      continue;
    }
    heads_[kept] = heads_[i];
    for (std::size_t j = 0; j < stride_; ++j)
      values_[kept * stride_ + j] = values_[i * stride_ + j];
    ++kept;
  }
  size_ = kept;
}

}  // namespace palpate::contact
