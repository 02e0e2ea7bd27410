// Computes the eigenmodes once; a step then multiplies every mode by its exact propagator.
#include "integrate/modal.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "base/child_process.h"
#include "base/dense.h"
#include "base/error.h"
#include "base/index.h"
#include "base/stopwatch.h"
#include "integrate/wide_loops.h"
#include "tissue/supports.h"

namespace palpate::integrate {

namespace {

using Columns = Eigen::MatrixXd;
constexpr Eigen::Index width = block_lanes;  // columns of a block, which are solved for together

// M^1/2 K^-1 M^1/2 over the free degrees of freedom, whose largest eigenvalues are 1 / omega^2 of
// the lowest modes.
class Softness {
 public:
  Softness(const Vector& mass, const std::vector<Eigen::Index>& free, SymmetricSolver& statics)
      : free_(&free), statics_(&statics) {
    loads_.fill(Vector::Zero(mass.size()));
    root_mass_.resize(static_cast<Eigen::Index>(free.size()));
    for (Eigen::Index i = 0; i < root_mass_.size(); ++i)
      root_mass_[i] = std::sqrt(mass[free[as_index(i)]]);
  }
  [[nodiscard]] const Vector& root_mass() const { return root_mass_; }

  [[nodiscard]] Columns operator*(const Eigen::Ref<const Columns>& block) {
    for (Eigen::Index c = 0; c < width; ++c) {
      const auto lane = as_index(c);
      for (Eigen::Index i = 0; i < root_mass_.size(); ++i)
        loads_[lane][(*free_)[as_index(i)]] = root_mass_[i] * block(i, c);
      moved_[lane].resize(0);  // the result must not depend on the vectors before
    }
    if (!statics_->solve(loads_, moved_)) throw MeshError(tissue::not_held);
    Columns image(block.rows(), width);
    for (Eigen::Index c = 0; c < width; ++c)
      for (Eigen::Index i = 0; i < root_mass_.size(); ++i)
        image(i, c) = root_mass_[i] * moved_[as_index(c)][(*free_)[as_index(i)]];
    return image;
  }

 private:
  const std::vector<Eigen::Index>* free_;
  SymmetricSolver* statics_;
  Vector root_mass_;  // kg^1/2
  std::array<Vector, block_lanes> loads_, moved_;
};

// Makes the columns of `block` orthonormal, and orthogonal to those of `basis`. Returns its
// coordinates before: first those in the basis, then those in the block as it is now.
Columns orthonormalise(const Eigen::Ref<const Columns>& basis, Columns& block) {
  Columns coordinates = Columns::Zero(basis.cols() + width, width);
  Columns left = Columns::Identity(width, width);
  for (int pass = 0; pass < 2; ++pass) {  // the second removes the rounding of the first
    const Columns along = basis.transpose() * block;
    block.noalias() -= basis * along;
    const dense::Qr factors = dense::qr(block);
    coordinates.topRows(basis.cols()) += along * left;
    left = dense::product(factors.r, left);
    block = factors.q;
  }
  coordinates.bottomRows(width) = left;
  return coordinates;
}

// The eigenvalues and eigenvectors of a matrix. A child process computes them, because Eigen knows
// no StopScope and takes minutes for some thousand degrees of freedom.
void decompose(const Eigen::MatrixXd& matrix, KnownModes& into) {
  const auto size = as_index(matrix.rows());
  const std::size_t squares = size * sizeof(double);  // bytes
  const std::size_t bytes = squares * (size + 1);
  const auto work = [&] {
    const dense::SymmetricModes found = dense::symmetric_modes(matrix);
    std::string answer(bytes, '\0');
    std::memcpy(answer.data(), found.values.data(), squares);
    std::memcpy(answer.data() + squares, found.vectors.data(), bytes - squares);
    return answer;
  };
  constexpr double unlimited = 1e7;  // s
  const ChildResult ended =
      run_in_child(work, {.time = unlimited, .memory = 1e8 + 8.0 * static_cast<double>(bytes)});
  if (!ended.good() || ended.output.size() != bytes)
    throw MeshError("the modes of " + std::to_string(size) +
                    " degrees of freedom do not fit into the memory; set `solver.modes` lower");
  into.squares.resize(matrix.rows());
  into.vectors.resize(matrix.rows(), matrix.rows());
  std::memcpy(into.squares.data(), ended.output.data(), squares);
  std::memcpy(into.vectors.data(), ended.output.data() + squares, bytes - squares);
}

}  // namespace

void Modal::find_free() {
  const auto held = body_->held();
  row_.assign(held.size(), -1);
  for (std::size_t d = 0; d < held.size(); ++d) {
    if (held[d] != 0) continue;
    row_[d] = static_cast<Eigen::Index>(free_.size());
    free_.push_back(static_cast<Eigen::Index>(d));
  }
}

Modal::Modal(const Body& body, KnownModes* known) : body_(&body), statics_(nullptr) {
  find_free();
  find_all(known);
}

Modal::Modal(const Body& body, Eigen::Index most, SymmetricSolver& statics, KnownModes* known)
    : body_(&body), statics_(&statics) {
  find_free();
  // Lanczos iterations need a basis of some twice as many vectors as there are modes.
  if (const auto size = static_cast<Eigen::Index>(free_.size()); 3 * most > size) {
    find_all(known);
    if (most < size) {
      omega_ = Vector(omega_.head(most));
      shapes_ = Shapes(shapes_.leftCols(most));
    }
  } else {
    find_lowest(most);
  }
}

void Modal::find_all(KnownModes* known) {
  const SplitMatrix stiffness = body_->stiffness().split(body_->held());
  const auto size = static_cast<Eigen::Index>(free_.size());
  Vector scale(size);
  for (Eigen::Index i = 0; i < size; ++i)
    scale[i] = 1.0 / std::sqrt(body_->mass()[free_[as_index(i)]]);
  Eigen::MatrixXd scaled = Eigen::MatrixXd::Zero(size, size);
  const auto add = [&](const Eigen::SparseMatrix<double>& matrix) {
    for (Eigen::Index column = 0; column < matrix.outerSize(); ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
        const Eigen::Index i = row_[as_index(entry.row())];
        const Eigen::Index j = row_[as_index(entry.col())];
        if (i >= 0 && j >= 0) scaled(i, j) += entry.value() * scale[i] * scale[j];
      }
  };
  add(stiffness.local);
  if (stiffness.weights.size() > 0)
    add(stiffness.shared.transpose() * stiffness.weights.asDiagonal() * stiffness.shared);
  KnownModes own;
  KnownModes& all = known != nullptr ? *known : own;
  if (all.matrix.rows() != size || all.matrix != scaled) {
    const Stopwatch watch;
    decompose(scaled, all);
    all.matrix = std::move(scaled);
    all.seconds = watch.seconds();
  } else {
    all.saved += all.seconds;
  }
  omega_ = all.squares.cwiseMax(0.0).cwiseSqrt();
  shapes_ = scale.asDiagonal() * all.vectors;
}

// Block Lanczos iterations with full orthogonalisation: the basis grows by a block until the modes
// that are asked for have converged.                             docs/theory.md [lowest_modes]
void Modal::find_lowest(Eigen::Index count) {
  constexpr double residual = 1e-5;  // of an eigenvector, as a fraction of its eigenvalue
  Softness softness(body_->mass(), free_, *statics_);
  const double usual = statics_->tolerance();
  statics_->set_tolerance(0.1 * residual);
  const auto size = static_cast<Eigen::Index>(free_.size());
  std::minstd_rand scatter;  // the same numbers on every machine
  Columns block(size, width);
  for (double& entry : block.reshaped())
    entry = static_cast<double>(scatter()) / static_cast<double>(std::minstd_rand::max()) - 0.5;
  Columns basis(size, 0);
  (void)orthonormalise(basis, block);
  Columns image;  // of the basis in the basis
  Eigen::Index next_look = count;
  for (Eigen::Index known = 0; omega_.size() == 0; known += width) {
    StopScope::end_if_stopped();
    const Eigen::Index more = known + width;
    if (more + width > size)
      throw MeshError("the lowest modes of the mesh were not found; set `solver.modes` lower");
    if (basis.cols() < more) basis.conservativeResize(Eigen::NoChange, std::max(more, 2 * known));
    basis.middleCols(known, width) = block;
    block = softness * block;
    const Columns coordinates = orthonormalise(basis.leftCols(more), block);
    image.conservativeResize(more, more);
    image.rightCols(width) = coordinates.topRows(more);
    image.bottomLeftCorner(width, known) = coordinates.topRows(known).transpose();
    if (more < next_look) continue;
    next_look = more + more / 8;
    const dense::SymmetricModes ritz = dense::symmetric_modes(image);
    const Columns vectors = ritz.vectors.rightCols(count).rowwise().reverse();
    const Vector values = ritz.values.tail(count).reverse();
    const Vector rest =
        (coordinates.bottomRows(width) * vectors.bottomRows(width)).colwise().norm();
    if ((rest.array() > residual * values.array()).any()) continue;
    omega_ = values.cwiseInverse().cwiseSqrt();
    shapes_ = softness.root_mass().cwiseInverse().asDiagonal() * (basis.leftCols(more) * vectors);
  }
  statics_->set_tolerance(usual);
}

void Modal::kept(const Vector& load, Vector& moved) const {
  modal_force(load, force_);
  amplitudes_ = force_.cwiseQuotient(omega_.cwiseAbs2());
  moved.setZero(load.size());
  add_shapes(amplitudes_, moved);
}

void Modal::dropped(const Vector& load, Vector& moved) const {
  moved.setZero(load.size());
  if (keeps_all()) return;
  Vector of_modes;
  kept(load, of_modes);
  if (!statics_->solve(load, moved)) throw MeshError(tissue::not_held);
  moved -= of_modes;
}

void Modal::prepare(double time_step) {
  if (time_step == prepared_step_) return;
  prepared_step_ = time_step;
  const Proportional& p = body_->proportional();
  const std::size_t components = 2 + p.branches.size();
  const Vector none = Vector::Zero(omega_.size());
  propagators_.keep.assign(components, std::vector<Vector>(components, none));
  propagators_.begin.assign(components, none);
  propagators_.end.assign(components, none);
  propagators_.damping = none;
  for (Eigen::Index i = 0; i < omega_.size(); ++i) {
    // x = (q, q'/omega, z_1, ...): q'' + (drag + retardation omega^2) q' + omega^2 q
    //   + sum of ratio omega^2 (q - z_i) = f,  z_i' = (q - z_i) / time_i  docs/theory.md [modes]
    const double omega = std::max(omega_[i], 1e-9 * omega_[omega_.size() - 1]);
    const double damping = p.drag_rate + p.retardation_time * omega * omega;
    const auto inner = static_cast<Eigen::Index>(p.branches.size());
    const Eigen::Index size = 2 + inner;
    Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size + 2, size + 2);
    system(0, 1) = omega;
    system(1, 0) = -omega;
    system(1, 1) = -damping;
    for (Eigen::Index b = 0; b < inner; ++b) {
      const auto& branch = p.branches[as_index(b)];
      system(1, 0) -= omega * branch.ratio;
      system(1, 2 + b) = omega * branch.ratio;
      system(2 + b, 0) = 1.0 / branch.time;
      system(2 + b, 2 + b) = -1.0 / branch.time;
    }
    // The force f0 + (f1 - f0) s with s' = 1/dt is represented by two more unknowns.
    system(1, size) = 1.0 / omega;
    system(size, size + 1) = 1.0 / time_step;
    const Eigen::MatrixXd exponent = system * time_step;
    const Eigen::MatrixXd whole = dense::exponential(exponent);
    for (Eigen::Index c = 0; c < size; ++c) {
      const auto to = as_index(c);
      for (Eigen::Index d = 0; d < size; ++d) propagators_.keep[to][as_index(d)][i] = whole(c, d);
      propagators_.end[to][i] = whole(c, size + 1);
      propagators_.begin[to][i] = whole(c, size) - whole(c, size + 1);
    }
    propagators_.damping[i] = damping / time_step;
  }
}

// Phi^T f over the degrees of freedom that are loaded.
void Modal::modal_force(const Vector& load, Vector& sum) const {
  sum.setZero(omega_.size());
  for (std::size_t i = 0; i < free_.size(); ++i)
    if (const double newton = load[free_[i]]; newton != 0.0)
      wide::add_scaled(as_index(sum.size()), newton,
                       shapes_.row(static_cast<Eigen::Index>(i)).data(), sum.data());
}

// all += Phi a
void Modal::add_shapes(const Vector& amplitudes, Vector& all) const {
  for (std::size_t i = 0; i < free_.size(); ++i)
    all[free_[i]] +=
        wide::product(as_index(amplitudes.size()), shapes_.row(static_cast<Eigen::Index>(i)).data(),
                      amplitudes.data());
}

// One component of the modes at the end of a step, from the modal forces at its start and end.
void Modal::next(std::size_t component, const Vector& before, const Vector& after,
                 Vector& sum) const {
  const auto size = as_index(omega_.size());
  sum.setZero(omega_.size());
  for (std::size_t d = 0; d < modes_.size(); ++d)
    wide::add_products(size, propagators_.keep[component][d].data(), modes_[d].data(), sum.data());
  wide::add_products(size, propagators_.begin[component].data(), before.data(), sum.data());
  wide::add_products(size, propagators_.end[component].data(), after.data(), sum.data());
}

// The modes move about the displacement at the start, which must be in equilibrium.
void Modal::start(const State& state) {
  if (started_) return;
  started_ = true;
  const Vector none = Vector::Zero(omega_.size());
  modes_.assign(2 + body_->proportional().branches.size(), none);
  load_before_ = load_after_ = work_ = lost_ = none;
  settled_ = state.displacement;
}

void Modal::begin(const State& state, double time_step, MemoryRule rule) {
  start(state);
  time_step_ = time_step;
  held_load_ = rule == MemoryRule::held;
  prepare(time_step);
}

bool Modal::linearise(const Vector&, const Vector& load) {
  modal_force(load, force_);
  base_ = settled_;
  next(0, held_load_ ? force_ : load_before_, force_, amplitudes_);
  add_shapes(amplitudes_, base_);
  return true;
}

void Modal::response(const Vector& load, Vector& moved) const {
  modal_force(load, force_);
  amplitudes_ = force_.cwiseProduct(propagators_.end[0]);
  moved.setZero(body_->mass().size());
  add_shapes(amplitudes_, moved);
}

void Modal::finish(State& state, const Vector& displacement, const Vector& load) {
  modal_force(load, force_);
  modes_after_.resize(modes_.size());
  for (std::size_t c = 0; c < modes_.size(); ++c)
    next(c, held_load_ ? force_ : load_before_, force_, modes_after_[c]);
  modes_.swap(modes_after_);
  load_before_ = force_;
  state.velocity.setZero();
  amplitudes_ = modes_[1].cwiseProduct(omega_);
  add_shapes(amplitudes_, state.velocity);
  state.displacement = displacement;
  state.time += time_step_;
  body_->arrive(state, {time_step_, MemoryRule::exact});
}

void Modal::press(Eigen::Index freedom, double load) {
  const Eigen::Index row = row_[as_index(freedom)];
  if (row < 0 || load == 0.0) return;
  if (load_after_.size() == 0) load_after_ = Vector::Zero(omega_.size());
  wide::add_scaled(as_index(omega_.size()), load, shapes_.row(row).data(), load_after_.data());
}

void Modal::pass(const State& start, double time_step) {
  if (!started_) {
    const Vector pressed = std::move(load_after_);
    this->start(start);
    if (pressed.size() > 0) load_after_ = pressed;
  }
  prepare(time_step);
  const Propagators& p = propagators_;
  wide::pass(as_index(omega_.size()), {.keep = {{p.keep[0][0].data(), p.keep[0][1].data()},
                                                {p.keep[1][0].data(), p.keep[1][1].data()}},
                                       .begin = {p.begin[0].data(), p.begin[1].data()},
                                       .end = {p.end[0].data(), p.end[1].data()},
                                       .force_before = load_before_.data(),
                                       .force_after = load_after_.data(),
                                       .damping = p.damping.data(),
                                       .x = {modes_[0].data(), modes_[1].data()},
                                       .work = work_.data(),
                                       .lost = lost_.data()});
  load_before_.swap(load_after_);
  load_after_.setZero();
}

void Modal::show(State& state) const {
  state.displacement = settled_;
  add_shapes(modes_[0], state.displacement);
  state.velocity.setZero();
  add_shapes(modes_[1].cwiseProduct(omega_), state.velocity);
  body_->memory_at(state.displacement, state.memory);
  state.force.resize(0);
}

// `held` is the sum of 1/2 omega^2 (q^2 + (q'/omega)^2) over the modes.
Modal::Energies Modal::energies() const {
  Energies sum;
  for (Eigen::Index i = 0; i < omega_.size(); ++i) {
    sum.work += work_[i];
    sum.lost += lost_[i];
    sum.held +=
        0.5 * omega_[i] * omega_[i] * (modes_[0][i] * modes_[0][i] + modes_[1][i] * modes_[1][i]);
  }
  return sum;
}

}  // namespace palpate::integrate
