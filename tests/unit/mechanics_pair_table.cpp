// What is kept of pairs of vertices is what they would say anew, whatever has changed.
#include "mechanics/influence.h"

#include <gtest/gtest.h>

namespace palpate::mechanics {
namespace {

// Another block for every pair; counts how often it is asked for.
struct Pairs {
  double shift = 0.0;
  int asked = 0;

  Eigen::Matrix3d block(int read, int pressed) {
    ++asked;
    Eigen::Matrix3d one = Eigen::Matrix3d::Constant(0.01 * pressed + shift);
    one.diagonal() << 1.0 + read, 2.0 - pressed, 3.0 * read;
    return one;
  }
  double at(PairTable& table, int read, int pressed) {
    return table.at(read, pressed, [&] { return block(read, pressed); });
  }
};

double anew(const Eigen::Matrix3d& block, const Vec3& read, const Vec3& pressed) {
  return read.dot(block * pressed);
}

TEST(PairTable, FollowsTheNormalsAndForgets) {
  PairTable table;
  Pairs pairs{.shift = 0.25};
  const Vec3 up = Vec3::UnitZ();
  const Vec3 tilted = Vec3(0.6, 0.0, 0.8);
  const std::array<std::array<Vec3, 2>, 4> looks{
      {{up, up}, {tilted, tilted}, {up, tilted}, {up, up}}};
  for (const auto& [read, pressed] : looks) {
    table.look(read, pressed);
    for (const int a : {7, 3})
      for (const int b : {5, 900}) {
        const double want = anew(Pairs{.shift = 0.25}.block(a, b), read, pressed);
        EXPECT_EQ(pairs.at(table, a, b), want);
        EXPECT_EQ(pairs.at(table, a, b), want);
      }
  }
  EXPECT_EQ(pairs.asked, 4);  // once a pair
  pairs.shift = 3.0;
  table.forget();
  EXPECT_EQ(pairs.at(table, 7, 5), anew(Pairs{.shift = 3.0}.block(7, 5), up, up));
}

TEST(PairTable, HoldsMoreVerticesThanItHasRoomFor) {
  PairTable table;
  Pairs pairs;
  table.look(Vec3::UnitX(), Vec3::UnitY());
  for (int round = 0; round < 2; ++round)
    for (int a = 0; a < 300; ++a)
      ASSERT_EQ(pairs.at(table, a, 2 * a),
                anew(Pairs{}.block(a, 2 * a), Vec3::UnitX(), Vec3::UnitY()));
}

// Forgetting clears all that was asked for, and no more than that: with its whole room, and through
// more vertices than that has.
TEST(PairTable, ForgetsAllPairsWithAllItsRoom) {
  PairTable table;
  table.make_room(600);
  for (const int vertices : {20, 200, 300})
    for (const double key : {1.0, 2.0}) {
      Pairs pairs{.shift = key + vertices};
      table.forget();
      table.look(Vec3::UnitX(), Vec3::UnitX());
      for (int a = 0; a < vertices; ++a)
        for (const int b : {0, a, 2 * a % vertices})
          ASSERT_EQ(pairs.at(table, a, b),
                    anew(Pairs{.shift = key + vertices}.block(a, b), Vec3::UnitX(), Vec3::UnitX()))
              << a << " " << b << " of " << vertices;
    }
}

}  // namespace
}  // namespace palpate::mechanics
