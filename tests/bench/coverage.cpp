// How often the truth lies inside the 95 % interval, model by model. No test: it prints the table
// of docs/identify.md. `palpate-coverage [REPEATS] [SCENE | rho=R | interval=TIME]...`; rho is the
// correlation of the noise of neighbouring points, and the interval that of the rows.
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
  double rho = 0.0;
  std::string interval;
  for (int k = 2; k < count; ++k) {
    const std::string word = words[k];
    if (word.starts_with("rho=")) rho = std::atof(word.substr(4).c_str());
    if (word.starts_with("interval=")) interval = word.substr(9);
  }
  for (test::IdentifyScene scene : test::identify_scenes()) {
    bool wanted = count <= 2;
    for (int k = 2; k < count; ++k) wanted = wanted || std::string(words[k]) == scene.name;
    if (!wanted) continue;
    if (const auto at = scene.text.find("interval = \"");
        !interval.empty() && at < scene.text.size())
      scene.text.replace(at + 12, scene.text.find('"', at + 12) - at - 12, interval);
    const auto start = std::chrono::steady_clock::now();
    const std::vector<test::Covered> covered =
        test::covered(scene, repeats, {.searches = 1, .profiles = false}, rho);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (std::size_t i = 0; i < covered.size(); ++i)
      std::printf("| %s | `%s` | %d | %.1f |\n", scene.name, scene.unknowns[i].c_str(),
                  covered[i].inside, 100.0 * std::sqrt(0.95 * 0.05 / repeats));
    std::fflush(stdout);
    std::fprintf(stderr, "%s: %.1f ms a fit\n", scene.name, 1e3 * seconds / repeats);
  }
  return 0;
}
