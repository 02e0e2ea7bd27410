// The creep of a load by one scalar recurrence for every degree of freedom.
#include "integrate/crept_load.h"

namespace palpate::integrate {

void CreptLoad::set_step(double time_step) {
  steps_.clear();
  const auto add = [&](double time) {
    steps_.push_back(rule_ == MemoryRule::first_order
                         ? tissue::MemoryStep::first_order(time_step, time)
                         : tissue::MemoryStep::exact(time_step, time));
  };
  if (law_.kind == tissue::Viscosity::kelvin_voigt) add(law_.time);
  for (const tissue::Branch& branch : law_.branches) add(branch.time);
}

void CreptLoad::pass(const Vector& load) {
  if (steps_.empty()) {
    crept_ = load;
    return;
  }
  if (crept_.size() == 0) {
    crept_ = Vector::Zero(load.size());
    memory_.assign(steps_.size(), crept_);
  }
  if (law_.branches.empty()) {
    // tau J' + J = L; the memory is the load before.                   docs/theory.md [memory]
    const tissue::MemoryStep& step = steps_.front();
    crept_ = step.keep * crept_ + step.begin * memory_.front() + step.end * load;
    memory_.front() = load;
    return;
  }
  // L_1 = J_1 + sum b (J_1 - q_1),  q_1 = keep q_0 + begin J_0 + end J_1  docs/theory.md [branches]
  double stiffness = 1.0;
  right_ = load;
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const double ratio = law_.branches[k].ratio;
    stiffness += ratio * (1.0 - steps_[k].end);
    memory_[k] = steps_[k].keep * memory_[k] + steps_[k].begin * crept_;
    right_ += ratio * memory_[k];
  }
  crept_ = right_ / stiffness;
  for (std::size_t k = 0; k < steps_.size(); ++k) memory_[k] += steps_[k].end * crept_;
}

void CreptLoad::renumber(const std::vector<Eigen::Index>& from) {
  const auto turn = [&](Vector& vector) {
    if (vector.size() == 0) return;
    const Vector old = vector;
    vector.resize(static_cast<Eigen::Index>(from.size()));
    for (std::size_t d = 0; d < from.size(); ++d)
      vector[static_cast<Eigen::Index>(d)] = from[d] < 0 ? 0.0 : old[from[d]];
  };
  turn(crept_);
  for (Vector& one : memory_) turn(one);
}

}  // namespace palpate::integrate
