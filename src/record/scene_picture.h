// The scene before anything moves, as far as a picture shows it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec3.h"

namespace palpate::record {

struct ScenePicture {
  struct Face {
    std::array<Vec3, 3> corners;  // m, counter-clockwise from outside
    int region = 0;               // that it bounds
    int within = -1;              // the region around that one; -1: none, it is on the skin
  };
  struct Sphere {
    Vec3 centre = Vec3::Zero();  // m
    double radius = 0.0;         // m
  };
  std::vector<Face> faces;             // of the specimen at rest; empty: no picture
  std::vector<std::string> materials;  // one a region
  std::vector<Sphere> finger;          // where it first touches
  double travel = 0.0;                 // m, the deepest
  Vec3 touch = Vec3::Zero();           // m, where the slides begin
  std::vector<Vec3> slides;            // m, one after the other
};

}  // namespace palpate::record
