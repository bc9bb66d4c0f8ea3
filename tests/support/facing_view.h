// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <functional>
#include <numbers>

#include "soslam/orientation/symmetry.h"
#include "support/random_scene.h"

namespace soslam {

inline const Box kWholeImage{0, 0, 639, 479};

// One edge pixel, off the samples (a distance of 0 is a kink), so that every pixel's nearest edge
// is the same, a vertical one, and maps that are linear in the pixel, which bilinear interpolation
// reproduces exactly: differences are free of the steps that real maps have.
inline EdgeMaps LinearMaps(const std::function<float(int x, int y)>& distance) {
  EdgeMaps maps;
  maps.grey = cv::Mat(480, 640, CV_8UC1);
  maps.edges = cv::Mat::zeros(480, 640, CV_8UC1);
  maps.edges.at<unsigned char>(200, 110) = 255;
  maps.nearest_edge = cv::Mat(480, 640, CV_16SC2, cv::Scalar(110, 200));
  maps.distance = cv::Mat(480, 640, CV_32FC1);
  for (int y = 0; y < 480; ++y) {
    for (int x = 0; x < 640; ++x) {
      maps.grey.at<unsigned char>(y, x) = static_cast<unsigned char>(std::min(x, 255));
      maps.distance.at<float>(y, x) = distance(x, y);
    }
  }
  return maps;
}

inline SymmetryImage SparseImage(const Box& box = kWholeImage) {
  SymmetryImage image(LinearMaps([](int x, int y) { return static_cast<float>(3 * x + 2 * y); }),
                      kWholeImage);
  image.box = box;
  return image;
}

// A landmark 3 m ahead with its x axis towards the camera and its z axis up.
inline Landmark FacingLandmark(const Eigen::Vector3d& half_axes,
                               const ShapeExponents& shape_exponents = kEllipsoidExponent) {
  Eigen::Matrix3d axes;
  axes << 0, 1, 0, 0, 0, -1, -1, 0, 0;
  return {{Eigen::Quaterniond(axes), {0, 0, 3}}, half_axes, shape_exponents};
}

// A landmark around the optical axis whose xz plane roughly contains the camera.
inline RandomView FacingView() {
  RandomView view;
  const Eigen::Quaterniond facing =
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX())) *
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  const Landmark landmark_in_camera{{ExpRotation(RandomVector(-0.2, 0.2)) * facing,
                                     Eigen::Vector3d(0, 0, 3) + RandomVector(-0.1, 0.1)},
                                    RandomVector(0.6, 0.9)};
  view.landmark_in_world = Transform(view.world_from_camera, landmark_in_camera);
  view.Move(Rigid3d());
  return view;
}

}  // namespace soslam
