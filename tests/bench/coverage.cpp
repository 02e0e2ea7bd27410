// How often the truth lies inside the 95 % interval, rung by rung. No test: it prints the table of
// docs/identify.md. `palpate-coverage [REPEATS] [SCENE]...`
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "identify_scenes.h"

int main(int count, char** words) {
  using namespace palpate;
  const int repeats = count > 1 ? std::atoi(words[1]) : 100;
  std::printf("| scene | unknown | inside, of %d | a right interval: 95 of 100, give or take |\n",
              repeats);
  std::printf("|---|---|---|---|\n");
  for (const test::IdentifyScene& scene : test::identify_scenes()) {
    bool wanted = count <= 2;
    for (int k = 2; k < count; ++k) wanted = wanted || std::string(words[k]) == scene.name;
    if (!wanted) continue;
    const auto start = std::chrono::steady_clock::now();
    const std::vector<int> inside = test::covered(scene, repeats);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (std::size_t i = 0; i < inside.size(); ++i)
      std::printf("| %s | `%s` | %d | %.1f |\n", scene.name, scene.unknowns[i].c_str(), inside[i],
                  100.0 * std::sqrt(0.95 * 0.05 / repeats));
    std::fflush(stdout);
    std::fprintf(stderr, "%s: %.1f ms a fit\n", scene.name, 1e3 * seconds / repeats);
  }
  return 0;
}
