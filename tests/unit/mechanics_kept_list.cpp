// Elements that leave a list leave their room in it, and nothing else.
#include "mechanics/contacts.h"

#include <gtest/gtest.h>

namespace palpate::mechanics {
namespace {

KeptList<SphereContact> numbered(int count) {
  KeptList<SphereContact> list;
  for (int i = 0; i < count; ++i) {
    SphereContact& one = list.add();
    one.sphere = i;
    one.load.vertices = {i, i + 1};
  }
  return list;
}

std::vector<int> spheres(const KeptList<SphereContact>& list) {
  std::vector<int> numbers;
  for (const SphereContact& one : list) {
    numbers.push_back(one.sphere);
    EXPECT_EQ(one.load.vertices, (std::vector<int>{one.sphere, one.sphere + 1}));
  }
  return numbers;
}

TEST(KeptList, KeepsTheOrderOfThoseThatStay) {
  KeptList<SphereContact> list = numbered(6);
  list.erase(2);
  EXPECT_EQ(spheres(list), (std::vector<int>{0, 1, 3, 4, 5}));
  list.erase_if([](const SphereContact& one) { return one.sphere % 2 == 1; });
  EXPECT_EQ(spheres(list), (std::vector<int>{0, 4}));
  list.erase(1);
  list.erase(0);
  EXPECT_TRUE(list.empty());
}

TEST(KeptList, CopiesAndMovesWhatIsInItAlone) {
  KeptList<SphereContact> list = numbered(3);
  list.erase(0);
  KeptList<SphereContact> copy = list;
  EXPECT_EQ(spheres(copy), (std::vector<int>{1, 2}));
  copy = numbered(5);
  EXPECT_EQ(spheres(copy), (std::vector<int>{0, 1, 2, 3, 4}));
  copy = list;
  EXPECT_EQ(spheres(copy), (std::vector<int>{1, 2}));
  EXPECT_EQ(spheres(list), (std::vector<int>{1, 2}));
  const KeptList<SphereContact> moved = std::move(copy);
  EXPECT_EQ(spheres(moved), (std::vector<int>{1, 2}));
  list.resize(3);
  EXPECT_EQ(list[2].sphere, 0);
  EXPECT_TRUE(list[2].load.vertices.empty());
  EXPECT_EQ(list[1].sphere, 2);
}

// Whatever a contact was, the one that comes after it begins with nothing but its room.
TEST(KeptList, GivesElementsThatAreLikeNew) {
  KeptList<SphereContact> list;
  SphereContact& old = list.add();
  old.sphere = 3;
  old.patch.a = old.patch.turned = old.approach = old.depth = old.force = 1.0;
  old.elastic = old.radiated = old.compliance = old.stiffness = 1.0;
  old.drag = old.stretch = Vec3::Ones();
  old.law.a = old.law.point.coefficient = 1.0;
  old.nodal.peak_pressure = 1.0;
  old.nodal.push.assign(10, Vec3::Ones());
  old.nodal.vertices.assign(10, 1);
  old.nodal.gap.assign(10, 1.0);
  for (contact::Spread* spread : {&old.load, &old.wide}) {
    spread->vertices.assign(100, 1);
    spread->shares.assign(100, 0.01);
  }
  old.on_crease = old.one_sided = true;
  const int* const room = old.wide.vertices.data();
  list.clear();
  const SphereContact& one = list.add();
  EXPECT_EQ(one.sphere, 0);
  for (const double number :
       {one.patch.a, one.patch.turned, one.approach, one.depth, one.force, one.elastic,
        one.radiated, one.compliance, one.stiffness, one.drag.norm(), one.stretch.norm(), one.law.a,
        one.law.point.coefficient, one.nodal.peak_pressure})
    EXPECT_EQ(number, 0.0);
  EXPECT_TRUE(one.load.vertices.empty() && one.load.shares.empty());
  EXPECT_TRUE(one.wide.vertices.empty() && one.wide.shares.empty());
  EXPECT_TRUE(one.nodal.push.empty() && one.nodal.vertices.empty() && one.nodal.gap.empty());
  EXPECT_FALSE(one.on_crease || one.one_sided);
  EXPECT_GE(one.wide.vertices.capacity(), 100U);
  EXPECT_EQ(one.wide.vertices.data(), room);
}

}  // namespace
}  // namespace palpate::mechanics
