// A block with a bonded base under a tangential traction of Hertz's shape, by bricks of 27 nodes.
// It shares nothing with the program; the test programs do not build it.
//
//   g++ -O2 -I/usr/include/eigen3 tests/elasticity/tangential.cpp -o tangential
//   ./tangential 60 60 30 4 0.33 12
//
// Arguments: length along the load, width, height, radius of the patch (mm), Poisson's ratio, cells
// along 5/4 of the radius. Prints the mean displacement (m/N), weighted with the traction, along
// the load of 1 N in the middle of the top; E is 72.4 kPa.
#include <Eigen/Dense>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/Sparse>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

// Equal cells over 5/4 of the radius, then growing by a third to the end.
std::vector<double> places(double end, double radius, int cells) {
  constexpr double growth = 1.35;
  double size = 1.25 * radius / cells;
  std::vector<double> all{0.0};
  for (int i = 1; i <= cells; ++i) all.push_back(i * size);
  const double inner = all.back();
  std::vector<double> outer;
  for (double x = inner; x < end;) outer.push_back(x += size *= growth);
  for (const double x : outer)
    all.push_back(inner + (x - inner) * (end - inner) / (outer.back() - inner));
  return all;
}

using Shape = std::array<double, 3>;
Shape values(double s) { return {0.5 * s * (s - 1.0), 1.0 - s * s, 0.5 * s * (s + 1.0)}; }
Shape slopes(double s) { return {s - 0.5, -2.0 * s, s + 0.5}; }

}  // namespace

int main(int count, char** words) {
  if (count != 7) return 2;
  const double radius = 1e-3 * std::atof(words[4]);
  const double nu = std::atof(words[5]);
  const int fine = std::atoi(words[6]);
  constexpr double modulus = 72.4e3;
  const double shear = 0.5 * modulus / (1.0 + nu);
  const double lame = 2.0 * shear * nu / (1.0 - 2.0 * nu);
  // A quarter: x along the load from the middle plane, which moves only along it; z downwards.
  const std::array<std::vector<double>, 3> edges{places(5e-4 * std::atof(words[1]), radius, fine),
                                                 places(5e-4 * std::atof(words[2]), radius, fine),
                                                 places(1e-3 * std::atof(words[3]), radius, fine)};
  std::array<int, 3> cells{}, nodes{};
  for (std::size_t d = 0; d < 3; ++d) {
    cells[d] = static_cast<int>(edges[d].size()) - 1;
    nodes[d] = 2 * cells[d] + 1;
  }
  const auto node = [&](int i, int j, int k) { return (k * nodes[1] + j) * nodes[0] + i; };
  std::vector<int> unknown(3UL * static_cast<std::size_t>(nodes[0] * nodes[1] * nodes[2]), -1);
  int free = 0;
  for (int k = 0; k + 1 < nodes[2]; ++k)
    for (int j = 0; j < nodes[1]; ++j)
      for (int i = 0; i < nodes[0]; ++i)
        for (int d = 0; d < 3; ++d)
          if (!(j == 0 && d == 1) && !(i == 0 && d != 0))
            unknown[static_cast<std::size_t>(3 * node(i, j, k) + d)] = free++;

  constexpr std::array<double, 3> at{-0.77459666924148338, 0.0, 0.77459666924148338};
  constexpr std::array<double, 3> weight{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  Eigen::Matrix<double, 6, 6> moduli = Eigen::Matrix<double, 6, 6>::Zero();
  moduli.topLeftCorner<3, 3>().setConstant(lame);
  for (int i = 0; i < 3; ++i) {
    moduli(i, i) += 2.0 * shear;
    moduli(i + 3, i + 3) = shear;
  }
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(free);
  double whole = 0.0;
  for (int ez = 0; ez < cells[2]; ++ez)
    for (int ey = 0; ey < cells[1]; ++ey)
      for (int ex = 0; ex < cells[0]; ++ex) {
        const std::array<int, 3> cell{ex, ey, ez};
        std::array<double, 3> low{}, size{};
        for (std::size_t d = 0; d < 3; ++d) {
          low[d] = edges[d][static_cast<std::size_t>(cell[d])];
          size[d] = edges[d][static_cast<std::size_t>(cell[d]) + 1] - low[d];
        }
        std::array<int, 81> number{};
        for (int m = 0; m < 27; ++m)
          for (int d = 0; d < 3; ++d)
            number[static_cast<std::size_t>(3 * m + d)] = unknown[static_cast<std::size_t>(
                3 * node(2 * ex + m % 3, 2 * ey + m / 3 % 3, 2 * ez + m / 9) + d)];
        Eigen::Matrix<double, 81, 81> stiffness = Eigen::Matrix<double, 81, 81>::Zero();
        for (std::size_t p = 0; p < 27; ++p) {
          const std::array<std::size_t, 3> q{p % 3, p / 3 % 3, p / 9};
          Eigen::Matrix<double, 6, 81> strain = Eigen::Matrix<double, 6, 81>::Zero();
          double volume = 1.0;
          for (std::size_t d = 0; d < 3; ++d) volume *= 0.5 * weight[q[d]] * size[d];
          for (std::size_t m = 0; m < 27; ++m) {
            const std::array<std::size_t, 3> c{m % 3, m / 3 % 3, m / 9};
            std::array<double, 3> slope{1.0, 1.0, 1.0};
            for (std::size_t d = 0; d < 3; ++d)
              for (std::size_t e = 0; e < 3; ++e)
                slope[d] *=
                    d == e ? slopes(at[q[e]])[c[e]] * 2.0 / size[e] : values(at[q[e]])[c[e]];
            const auto column = 3 * static_cast<Eigen::Index>(m);
            for (int d = 0; d < 3; ++d) strain(d, column + d) = slope[static_cast<std::size_t>(d)];
            strain(3, column) = strain(5, column + 2) = slope[1];
            strain(3, column + 1) = strain(4, column + 2) = slope[0];
            strain(4, column) = strain(5, column + 1) = slope[2];
          }
          stiffness += volume * strain.transpose() * moduli * strain;
        }
        for (int i = 0; i < 81; ++i)
          for (int j = 0; j < 81; ++j) {
            const int row = number[static_cast<std::size_t>(i)];
            const int column = number[static_cast<std::size_t>(j)];
            if (column >= 0 && row >= column) entries.emplace_back(row, column, stiffness(i, j));
          }
        if (ez > 0 || low[0] > radius || low[1] > radius) continue;
        constexpr int samples = 40;
        for (int u = 0; u < samples; ++u)
          for (int v = 0; v < samples; ++v) {
            const double s = (2.0 * u + 1.0) / samples - 1.0;
            const double t = (2.0 * v + 1.0) / samples - 1.0;
            const double x = low[0] + 0.5 * size[0] * (s + 1.0);
            const double y = low[1] + 0.5 * size[1] * (t + 1.0);
            const double inside = 1.0 - (x * x + y * y) / (radius * radius);
            if (inside <= 0.0) continue;
            const double force = std::sqrt(inside) * size[0] * size[1];
            whole += force;
            for (std::size_t m = 0; m < 9; ++m)
              if (const int row = number[3 * m]; row >= 0)
                load[row] += force * values(s)[m % 3] * values(t)[m / 3];
          }
      }
  load *= 0.25 / whole;
  Eigen::SparseMatrix<double> matrix(free, free);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower,
                           Eigen::IncompleteCholesky<double, Eigen::Lower>>
      solver;
  solver.setTolerance(1e-7);
  solver.compute(matrix);
  const Eigen::VectorXd moved = solver.solve(load);
  std::printf("%.5e m/N with %d unknowns\n", 4.0 * load.dot(moved), free);
}
