// VegaFEM's springs for palpate-versus: the elastic forces of a MassSpringSystem.
#include <algorithm>
#include <cstddef>
#include <numeric>

#include "bench/peers.h"
#include "massSpringSystem.h"

namespace palpate::versus {
namespace {

// Its integrators solve a sparse system in each step. Only the forces are taken, without gravity,
// damping and the step itself.
class VegaFem final : public Peer {
 public:
  VegaFem(Model model, Groups groups)
      : displacement_(model.rest.size()),
        force_(model.rest.size()),
        group_(group_numbers(model.ends.size(), groups)),
        damping_(groups == Groups::one ? 1 : model.ends.size()),
        springs_(static_cast<int>(model.mass.size()), model.mass.data(), model.rest.data(),
                 static_cast<int>(model.ends.size()), model.ends.front().data(), group_.data(),
                 static_cast<int>(damping_.size()), model.stiffness.data(), damping_.data()) {}

  void force(std::span<const double> displacement, std::span<double> force) override {
    std::copy(displacement.begin(), displacement.end(), displacement_.begin());
    step();
    std::copy(force_.begin(), force_.end(), force.begin());
  }
  void step() override { springs_.ComputeForce(displacement_.data(), force_.data()); }
  [[nodiscard]] bool steps_in_time() const override { return false; }
  void displacement(std::span<double> displacement) const override {
    std::copy(displacement_.begin(), displacement_.end(), displacement.begin());
  }

 private:
  static std::vector<int> group_numbers(std::size_t springs, Groups groups) {
    std::vector<int> numbers(springs, 0);
    if (groups == Groups::each) std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
  }

  std::vector<double> displacement_;  // m
  std::vector<double> force_;         // N
  std::vector<int> group_;
  std::vector<double> damping_;  // N s/m, zero
  MassSpringSystem springs_;
};

}  // namespace

std::unique_ptr<Peer> make_vegafem(const Model& model, Groups groups) {
  return std::make_unique<VegaFem>(model, groups);
}

}  // namespace palpate::versus
