// What one explicit step of a whole body costs, form by form, beside the plain loops in the same
// run. No test: it prints a table. `palpate-step [MESHES]` takes 1 to 3 meshes, small to large;
// `palpate-step growth` lattices of up to 1e6 tetrahedra.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bench/plain_step.h"
#include "integrate/central_difference.h"
#include "mechanics/monitor.h"
#include "scene/spring_body.h"
#include "tissue/network.h"

namespace palpate {
namespace {

// The least time of a call, s: other programs on the machine only ever add.
template <class Work>
double least(const Work& work) {
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point from) {
    return std::chrono::duration<double>(Clock::now() - from).count();
  };
  const Clock::time_point start = Clock::now();
  work();
  const int calls = std::clamp(static_cast<int>(50e-6 / seconds(start)), 1, 1000);
  double best = 1e9;
  for (int round = 0; round < 3 || seconds(start) < 0.5; ++round) {
    const Clock::time_point now = Clock::now();
    for (int i = 0; i < calls; ++i) work();
    best = std::min(best, seconds(now) / calls);
    if (seconds(start) > 10.0) break;
  }
  return best;
}

void report(const geometry::TetMesh& mesh, const Case& form, bool skip_plain) {
  const tissue::Network& network = *form.network;
  const std::vector<char> held = held_base(mesh);
  const double squared =
      form.law.instantaneous_ratio() * tissue::largest_frequency_squared(network, held);
  const double dt = 0.9 * 2.0 / std::sqrt(squared);
  const Vector load = press(mesh);

  integrate::State state = at_rest(network, form.law);
  const scene::SpringBody body(network, form.kinematics, form.law, held);
  integrate::CentralDifference method(body, dt, integrate::Start::consistent);
  const double step = least([&] { method.step(state, load); });
  mechanics::EnergyMonitor monitor(body);
  integrate::State before = state;
  method.step(state, load);
  const double watched = least([&] { (void)monitor.step(before, state, load, load); });
  double plain = 0.0;
  if (!skip_plain) {
    state = at_rest(network, form.law);
    PlainStep reference(form, held, dt);
    plain = least([&] { reference.step(state, load); });
  }
  const double springs = static_cast<double>(network.ends.size());
  char ratio[64] = "-";
  if (!skip_plain) std::snprintf(ratio, sizeof ratio, "%.1f | %.1f", 1e6 * plain, plain / step);
  std::printf("| %d | %d | %s | %.2f | %.2f | %.2f | %s | %.0f |\n", network.nodes(),
              network.springs(), form.name.c_str(), 1e6 * step, 1e9 * step / springs, 1e6 * watched,
              skip_plain ? "- | -" : ratio, 1e6 * dt);
  std::fflush(stdout);
}

void report_mesh(int which) {
  const geometry::TetMesh mesh =
      which == 0 ? geometry::cuboid(block_size(), {3, 4, 6}, geometry::CellPattern::kuhn)
                 : meshing::tetgen_cuboid(block_size(), which == 1 ? 728 : 20000, 600.0);
  const auto [springs, coupled] = make_networks(mesh);
  const tissue::ViscousLaw none;
  const tissue::ViscousLaw solid{.kind = Viscosity::standard_linear_solid,
                                 .branches = {{0.1, 0.5}}};
  const tissue::ViscousLaw voigt{.kind = Viscosity::kelvin_voigt, .time = 0.1};
  report(mesh, {"linear", &springs, Kinematics::linear, none}, false);
  report(mesh, {"non-linear", &springs, Kinematics::nonlinear, none}, false);
  report(mesh, {"linear, standard linear solid", &springs, Kinematics::linear, solid}, false);
  report(mesh, {"coupled, nodal volumes", &coupled, Kinematics::linear, none}, false);
  report(mesh, {"coupled non-linear", &coupled, Kinematics::squared, none}, false);
  if (which == 2) return;  // factors of half a gigabyte
  report(mesh, {"linear Kelvin-Voigt", &springs, Kinematics::linear, voigt}, false);
  report(mesh, {"non-linear Kelvin-Voigt", &springs, Kinematics::nonlinear, voigt}, false);
  report(mesh, {"coupled Kelvin-Voigt", &coupled, Kinematics::linear, voigt}, true);
}

// MB, the most that this process has had.
double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Lattices of 1e3 to 1e6 tetrahedra: set-up, memory and step, over what the first of them says.
void report_growth() {
  std::printf(
      "| tetrahedra | nodes | springs | network, s | stable step, s | memory, MB | linear, us | ns "
      "a spring | coupled, us | ns a tetrahedron |\n|---|---|---|---|---|---|---|---|---|---|\n");
  const auto seconds = [](const auto& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  for (const int cells : {6, 12, 26, 55}) {
    const geometry::TetMesh mesh =
        geometry::cuboid(block_size(), {cells, cells, cells}, geometry::CellPattern::mirrored);
    Networks networks;
    const double building = seconds([&] { networks = make_networks(mesh); });
    const std::vector<char> held = held_base(mesh);
    double squared = 0.0;
    const double looking =
        seconds([&] { squared = tissue::largest_frequency_squared(networks.coupled, held); });
    const double dt = 1.8 / std::sqrt(squared);
    const Vector load = press(mesh);
    const tissue::ViscousLaw none;
    double steps[2] = {};
    for (const bool coupled : {false, true}) {
      const tissue::Network& network = coupled ? networks.coupled : networks.springs;
      const scene::SpringBody body(network, Kinematics::linear, none, held);
      integrate::CentralDifference method(body, dt, integrate::Start::consistent);
      integrate::State state = at_rest(network, none);
      steps[coupled ? 1 : 0] = least([&] { method.step(state, load); });
    }
    const auto tetrahedra = static_cast<double>(mesh.tetrahedra.size());
    std::printf("| %zu | %zu | %d | %.2f | %.2f | %.0f | %.1f | %.2f | %.1f | %.2f |\n",
                mesh.tetrahedra.size(), mesh.nodes.size(), networks.springs.springs(), building,
                looking, peak_memory(), 1e6 * steps[0], 1e9 * steps[0] / networks.springs.springs(),
                1e6 * steps[1], 1e9 * steps[1] / tetrahedra);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "growth") {
    palpate::report_growth();
    return 0;
  }
  const int meshes = argc > 1 ? std::atoi(argv[1]) : 3;
  std::printf(
      "| nodes | springs | form | step, us | ns a spring | energy watch, us | plain, us | "
      "plain / step | dt, us |\n|---|---|---|---|---|---|---|---|---|\n");
  for (int which = 0; which < meshes; ++which) palpate::report_mesh(which);
  return 0;
}
