// The parts of a scene at rest that a picture shows.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec3.h"

namespace palpate::record {

struct ScenePicture {
  struct Face {
    std::array<Vec3, 3> corners;  // m, counter-clockwise from outside
    int region = 0;               // on the inner side of the face
    int within = -1;              // region on the outer side; -1: the face is part of the surface
    bool held = false;            // by the base
  };
  struct Sphere {
    Vec3 centre = Vec3::Zero();  // m
    double radius = 0.0;         // m
  };
  std::vector<Face> faces;             // of the specimen at rest; empty: no picture
  std::vector<std::string> materials;  // one per region
  std::string base;                    // what holds the held faces
  std::vector<Sphere> finger;          // at its first touch
  double travel = 0.0;                 // m, the deepest
  Vec3 touch = Vec3::Zero();           // m, on the surface, where the first slide begins
  std::vector<Vec3> slides;            // m, displacements, each from the end of the previous one
  Vec3 towards = -Vec3::UnitZ();       // the direction of the press
  // The directions of the scenario's x, y and z in the picture, where z is up.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

}  // namespace palpate::record
