// CHAI3D's deformable bodies for palpate-versus: mass particles and linear springs in a cGELWorld.
#include <cstddef>

#include "CGELMesh.h"
#include "CGELWorld.h"
#include "bench/peers.h"

// Meshes and images may be read from files, which takes five more libraries; a step reads none.
namespace chai3d {
#define PALPATE_NO_FILES(kind, Type)                                \
  bool cLoadFile##kind(Type*, const std::string&) { return false; } \
  bool cSaveFile##kind(Type*, const std::string&) { return false; }
PALPATE_NO_FILES(BMP, cImage)
PALPATE_NO_FILES(GIF, cImage)
PALPATE_NO_FILES(JPG, cImage)
PALPATE_NO_FILES(PNG, cImage)
PALPATE_NO_FILES(PPM, cImage)
PALPATE_NO_FILES(RAW, cImage)
PALPATE_NO_FILES(STB, cImage)
PALPATE_NO_FILES(3DS, cMultiMesh)
PALPATE_NO_FILES(OBJ, cMultiMesh)
PALPATE_NO_FILES(STL, cMultiMesh)
PALPATE_NO_FILES(TRI, cMultiMesh)
#undef PALPATE_NO_FILES
}  // namespace chai3d

namespace palpate::versus {
namespace {

chai3d::cVector3d vector_at(std::span<const double> values, std::size_t node) {
  return {values[3 * node], values[3 * node + 1], values[3 * node + 2]};
}

// Its step is symplectic Euler with the drag of the velocity before the step. It computes current
// lengths and directions.
class Chai3d final : public Peer {
 public:
  explicit Chai3d(const Model& model) : rest_(model.rest), time_step_(model.time_step) {
    chai3d::cMesh* mesh = mesh_.newMesh();
    for (std::size_t i = 0; i < model.mass.size(); ++i) mesh->newVertex(vector_at(rest_, i));
    mesh_.buildVertices();
    mesh_.m_useMassParticleModel = true;
    for (std::size_t i = 0; i < model.mass.size(); ++i) {
      cGELMassParticle& particle = at(i);
      particle.setMass(model.mass[i]);
      particle.m_useGravity = false;
      particle.m_kDampingPos = model.drag;
      particle.m_fixed = model.held[i] != 0;
      chai3d::cVector3d load = vector_at(model.load, i);
      particle.setExternalForce(load);
    }
    springs_.reserve(model.ends.size());
    for (std::size_t s = 0; s < model.ends.size(); ++s) {
      const auto [first, second] = model.ends[s];
      springs_.push_back(std::make_unique<cGELLinearSpring>(&at(static_cast<std::size_t>(first)),
                                                            &at(static_cast<std::size_t>(second))));
      springs_.back()->m_kSpringElongation = model.stiffness[s];
      mesh_.m_linearSprings.push_back(springs_.back().get());
    }
    world_.m_gelMeshes.push_back(&mesh_);
  }
  ~Chai3d() override {
    for (cGELVertex& vertex : mesh_.m_gelVertices) delete vertex.m_massParticle;  // never by theirs
  }

  void force(std::span<const double> displacement, std::span<double> force) override {
    place(displacement);
    world_.updateDynamics(0.0);  // computes forces, moves nothing
    for (std::size_t d = 0; d < force.size(); ++d) force[d] = -at(d / 3).m_force(d % 3);
    place(std::vector<double>(rest_.size(), 0.0));
  }
  void step() override { world_.updateDynamics(time_step_); }
  [[nodiscard]] bool steps_in_time() const override { return true; }
  void displacement(std::span<double> displacement) const override {
    for (std::size_t d = 0; d < displacement.size(); ++d)
      displacement[d] = at(d / 3).m_pos(d % 3) - rest_[d];
  }

 private:
  [[nodiscard]] cGELMassParticle& at(std::size_t node) const {
    return *mesh_.m_gelVertices[node].m_massParticle;
  }
  void place(std::span<const double> displacement) {
    for (std::size_t i = 0; i < mesh_.m_gelVertices.size(); ++i) {
      at(i).m_pos = vector_at(rest_, i) + vector_at(displacement, i);
      at(i).m_vel.zero();
    }
  }

  std::vector<double> rest_;  // m
  double time_step_;          // s
  cGELMesh mesh_;
  cGELWorld world_;
  std::vector<std::unique_ptr<cGELLinearSpring>> springs_;
};

}  // namespace

std::unique_ptr<Peer> make_chai3d(const Model& model) { return std::make_unique<Chai3d>(model); }

}  // namespace palpate::versus
