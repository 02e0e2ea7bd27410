// One kernel, so many times: what valgrind counts the instructions of, set-up and the first twenty
// calls excluded. `palpate-instructions` alone lists the kernels; `palpate-instructions KERNEL
// TIMES` runs one, under `valgrind --tool=callgrind --instr-atstart=no`.
#include <valgrind/callgrind.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

#include "bench/plain_step.h"
#include "contact/hertz.h"
#include "integrate/central_difference.h"
#include "mechanics/pressed_mesh.h"
#include "scene/first_touch.h"
#include "scene/spring_body.h"
#include "scene_text.h"

namespace palpate {
namespace {

using Kernel = std::function<void(int)>;

// Calls `once` with 0, 1, ... and counts the last `times` calls.
template <class Once>
void count(int times, const Once& once) {
  constexpr int warming = 20;
  for (int i = 0; i < warming; ++i) once(i);
  CALLGRIND_START_INSTRUMENTATION;
  for (int i = warming; i < warming + times; ++i) once(i);
  CALLGRIND_STOP_INSTRUMENTATION;
}

constexpr double time_step = 1e-4;  // s: stable on the cube in every form

// A step of the paper's cube: `plain` as the formulas are written, or the program's own.
Kernel step(Kinematics kinematics, bool coupled, bool plain) {
  return [=](int times) {
    const geometry::TetMesh mesh =
        geometry::cuboid(block_size(), {3, 4, 6}, geometry::CellPattern::kuhn);
    const Networks networks = make_networks(mesh);
    const tissue::Network& network = coupled ? networks.coupled : networks.springs;
    const tissue::ViscousLaw none;
    const std::vector<char> held = held_base(mesh);
    const Vector load = press(mesh);
    integrate::State state = at_rest(network, none);
    if (plain) {
      PlainStep steps({"", &network, kinematics, none}, held, time_step);
      count(times, [&](int) { steps.step(state, load); });
      return;
    }
    const scene::SpringBody body(network, kinematics, none, held);
    integrate::CentralDifference steps(body, time_step, integrate::Start::consistent);
    count(times, [&](int) { steps.step(state, load); });
  };
}

// A millisecond of a press of a small block: contacts, forces, mesh and its energies.
Kernel frame(const char* coupling, const char* integrator, const char* viscosity) {
  return [=](int times) {
    const std::string text =
        std::string("[tissue]\nmaterial = \"skin\"\nviscosity = \"") + viscosity +
        "\"\nmesh = { kind = \"kuhn\", cells = [2, 3, 4] }\n[contact]\ncoupling = \"" + coupling +
        "\"\n[solver]\nmodel = \"mass_spring\"\nintegrator = \"" + integrator +
        "\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n";
    const scene::Scene scene = test::scene_of(text);
    const scene::TimePlan& plan = scene.specimen->plan;
    mechanics::PressedMesh mesh(scene);
    mechanics::ContactHistory history(scene);
    mechanics::Touch touch;
    const Vec3 first = scene::first_touch(scene).finger;
    mesh.set_step(plan.substep);
    touch.finger = first;
    double time = 0.0;
    count(times, [&](int i) {
      for (int k = 1; k <= plan.substeps; ++k) {
        time += plan.substep;
        const double travel = 1e-3 * (i + static_cast<double>(k) / plan.substeps) / 1000.0;
        if (mesh.step(first - travel * Vec3::UnitZ(), time, history, touch)) std::abort();
      }
    });
  };
}

// Of the closed form, a thousand calls a time.
void hertz_law(int times) {
  volatile double sum = 0.0;
  count(times, [&](int) {
    for (int k = 0; k < 1000; ++k) sum = sum + contact::hertz::force(1e-6 * k, 0.011, 80e3);
  });
}

const std::map<std::string, Kernel>& kernels() {
  static const std::map<std::string, Kernel> all{
      {"hertz_law_1000", hertz_law},
      {"step_linear", step(Kinematics::linear, false, false)},
      {"step_linear_plain", step(Kinematics::linear, false, true)},
      {"step_nonlinear", step(Kinematics::nonlinear, false, false)},
      {"step_nonlinear_plain", step(Kinematics::nonlinear, false, true)},
      {"step_coupled", step(Kinematics::linear, true, false)},
      {"step_coupled_plain", step(Kinematics::linear, true, true)},
      {"frame_modal", frame("consistent", "modal", "kelvin_voigt")},
      {"frame_one_way", frame("one_way", "central_difference", "none")},
      {"frame_series", frame("series", "central_difference", "none")},
  };
  return all;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const auto& kernels = palpate::kernels();
  const auto found = argc == 3 ? kernels.find(argv[1]) : kernels.end();
  if (found == kernels.end()) {
    for (const auto& [name, kernel] : kernels) std::printf("%s\n", name.c_str());
    return argc == 1 ? 0 : 2;
  }
  found->second(std::atoi(argv[2]));
  return 0;
}
