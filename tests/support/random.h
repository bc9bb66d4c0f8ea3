// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <random>

#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/rigid3.h"

namespace soslam {

// The generator that all random inputs of a test come from; reseeded before every test.
inline std::mt19937& TestRandom() {
  static std::mt19937 generator(20220101);
  return generator;
}

inline double RandomUniform(double min, double max) {
  return std::uniform_real_distribution<double>(min, max)(TestRandom());
}

inline Eigen::Vector3d RandomVector(double min, double max) {
  return {RandomUniform(min, max), RandomUniform(min, max), RandomUniform(min, max)};
}

inline double RandomNormal(double sigma = 1.0) {
  return std::normal_distribution<double>(0.0, sigma)(TestRandom());
}

inline Eigen::Vector3d RandomNormalVector(double sigma) {
  return {RandomNormal(sigma), RandomNormal(sigma), RandomNormal(sigma)};
}

inline Eigen::Quaterniond RandomRotation() {
  std::normal_distribution<double> normal;
  auto& random = TestRandom();
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized();
}

inline Rigid3d RandomRigid(double extent = 3.0) {
  return {RandomRotation(), RandomVector(-extent, extent)};
}

inline Plane RandomPlane() { return {RandomVector(-1, 1).normalized(), RandomUniform(-3, 3)}; }

inline Camera TestCamera() { return {640, 480, 520.0, 530.0, 318.0, 242.0}; }

// A landmark of any orientation, wholly in front of a camera at the origin.
inline Landmark RandomLandmarkInCamera() {
  return {{RandomRotation(),
           {RandomUniform(-0.8, 0.8), RandomUniform(-0.6, 0.6), RandomUniform(2.5, 5.0)}},
          RandomVector(0.1, 0.8)};
}

}  // namespace soslam
