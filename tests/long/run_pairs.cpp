// Every pair of choices that concern mesh, model and loading occurs in some scenario, which runs or
// is refused with words. `./dev sanitize -R Pairs` runs it with the assertions of the library.
#include <array>
#include <random>
#include <set>

#include "base/error.h"
#include "run_text.h"

namespace palpate::run {
namespace {

using Lines = std::vector<std::string>;

// The values of each choice, as lines of a scenario; the first is the default.
const std::vector<Lines> choices{
    {"shape = { kind = \"cuboid\", size = [\"20 mm\", \"20 mm\", \"10 mm\"] }\n",
     "shape = { kind = \"half_space\" }\n", "shape = { kind = \"half_space\", curvature = 20 }\n",
     "shape = { kind = \"cylinder\" }\n", "shape = { kind = \"ligament\" }\n",
     "shape = { kind = \"as_meshed\" }\n"},
    {"mesh = { kind = \"kuhn\", cells = [3, 3, 3] }\n",
     "mesh = { kind = \"mirrored\", cells = [3, 3, 2] }\n",
     "mesh = { kind = \"tetgen\", nodes = 60 }\n"},
    {"", "viscosity = \"none\"\n", "viscosity = \"nodal_drag\"\n", "viscosity = \"kelvin_voigt\"\n",
     "viscosity = \"standard_linear_solid\"\n",
     "viscosity = \"prony\"\n[[tissue.branch]]\nrelaxation_time = \"0.1 s\"\nratio = 0.5\n"},
    {"", "[tissue]\nbase = \"bonded\"\n", "[tissue]\nbase = \"frictionless\"\n"},
    {"", "coupling = \"one_way\"\n", "coupling = \"series\"\n", "coupling = \"consistent\"\n",
     "coupling = \"resolved\"\n"},
    {"", "model = \"hertz\"\n", "model = \"layer\"\n", "model = \"mass_spring\"\n",
     "model = \"coupled_springs\"\n", "model = \"solid\"\n"},
    {"", "integrator = \"central_difference\"\n", "integrator = \"semi_implicit_euler\"\n",
     "integrator = \"quasi_static\"\n", "integrator = \"backward_difference\"\n",
     "integrator = \"tr_bdf2\"\n", "integrator = \"modal\"\n"},
    {"[[step]]\nkind = \"indent\"\nto = \"0.4 mm\"\nrate = \"40 mm/s\"\n",
     "[[step]]\nkind = \"indent\"\nto = \"0.02 N\"\nrate = \"40 mm/s\"\n",
     "[[step]]\nkind = \"creep\"\nstress = \"1 kPa\"\ntime = \"10 ms\"\n",
     "[[step]]\nkind = \"relax\"\nstrain = 0.01\ntime = \"10 ms\"\n"}};
constexpr std::size_t base = 3;
constexpr std::size_t coupling = 4;
constexpr std::size_t model = 5;
constexpr std::size_t step = 7;

using Row = std::vector<std::size_t>;  // the value of each choice

// `base` stands in the table that `viscosity` may have ended with a branch.
std::string text_of(const Row& row) {
  const auto line = [&](std::size_t choice) { return choices[choice][row[choice]]; };
  std::string text = "[tissue]\n" + line(0) + line(1);
  if (row[base] > 0) text += line(base).substr(line(base).find('\n') + 1);
  text += line(2);
  const bool uniform = row[step] > 1;
  if (!uniform)
    text += "[finger]\nmaterial = \"rigid\"\nradius = \"5 mm\"\n[contact]\n" + line(coupling);
  return text + "[solver]\n" + line(model) + line(6) + line(step) +
         "[output]\ninterval = \"10 ms\"\nfigures = false\npressure_maps = false\n";
}

using Pair = std::array<std::size_t, 4>;  // choice, value, choice, value

std::set<Pair> pairs_of(const Row& row) {
  std::set<Pair> pairs;
  for (std::size_t a = 0; a < row.size(); ++a)
    for (std::size_t b = a + 1; b < row.size(); ++b) pairs.insert({a, row[a], b, row[b]});
  return pairs;
}

// Rows in which all pairs occur beside any others; those of a shape or a model also beside
// defaults, so that no third choice hides what they do.
std::vector<Row> rows() {
  std::vector<Row> all;
  std::set<Pair> left;
  for (std::size_t a = 0; a < choices.size(); ++a)
    for (std::size_t b = a + 1; b < choices.size(); ++b)
      for (std::size_t i = 0; i < choices[a].size(); ++i)
        for (std::size_t k = 0; k < choices[b].size(); ++k) {
          Row row(choices.size(), 0);
          row[a] = i;
          row[b] = k;
          const bool few = a == 0 || a == model || b == model;
          if (few && i > 0 && k > 0) all.push_back(row);
          left.insert({a, i, b, k});
        }
  std::mt19937 random(2007);  // a fixed seed: the same rows everywhere
  while (!left.empty()) {
    Row best;
    std::size_t most = 0;
    for (int tries = 0; tries < 30; ++tries) {
      Row row;
      for (const Lines& values : choices) row.push_back(random() % values.size());
      const Pair& wanted = *left.begin();
      row[wanted[0]] = wanted[1];
      row[wanted[2]] = wanted[3];
      std::size_t found = 0;
      for (const Pair& pair : pairs_of(row)) found += left.count(pair);
      if (found > most) best = row;
      most = std::max(most, found);
    }
    all.push_back(best);
    for (const Pair& pair : pairs_of(best)) left.erase(pair);
  }
  return all;
}

TEST(Pairs, RunOrAreRefusedWithWords) {
  int ran = 0;
  int refused = 0;
  for (const Row& row : rows()) {
    const std::string text = text_of(row);
    SCOPED_TRACE(text);
    try {
      const record::CaseRecord record = test::run_text(text);
      EXPECT_TRUE(record.outcome == record::Outcome::completed || !record.reason.empty());
      ++ran;
    } catch (const InputError& error) {
      EXPECT_FALSE(error.problems().empty());
      ++refused;
    } catch (const MeshError& error) {
      EXPECT_STRNE(error.what(), "");
      ++refused;
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GT(ran, 50);
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace palpate::run
