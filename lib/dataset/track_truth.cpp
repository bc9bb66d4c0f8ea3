// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/track_truth.h"

#include <algorithm>

namespace soslam {
namespace {

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Median of each coordinate.
template <typename Vector>
Eigen::Vector3d Median(const std::vector<Landmark>& landmarks, const Vector& vector) {
  Eigen::Vector3d median;
  for (int i = 0; i < 3; ++i) {
    std::vector<double> values;
    for (const Landmark& landmark : landmarks) values.push_back(vector(landmark)[i]);
    median[i] = Median(std::move(values));
  }
  return median;
}

Landmark MedianLandmark(const std::vector<Landmark>& landmarks) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  Eigen::Vector3d front = Eigen::Vector3d::Zero();
  for (const Landmark& landmark : landmarks) {
    up += landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
    front += landmark.frame_from_object.rotation * Eigen::Vector3d::UnitX();
  }
  up.normalize();
  front = (front - front.dot(up) * up).normalized();
  Eigen::Matrix3d rotation;
  rotation << front, up.cross(front), up;
  Landmark median = landmarks.front();
  median.frame_from_object = {
      Eigen::Quaterniond(rotation).normalized(),
      Median(landmarks, [](const Landmark& landmark) { return landmark.Centre(); })};
  median.half_axes = Median(landmarks, [](const Landmark& landmark) { return landmark.half_axes; });
  return median;
}

bool IsStatic(const std::vector<Landmark>& landmarks, const Eigen::Vector3d& median,
              const KittiOptions& options) {
  const auto near = std::count_if(landmarks.begin(), landmarks.end(), [&](const Landmark& view) {
    return (view.Centre() - median).norm() <= options.static_radius_m;
  });
  const auto views = static_cast<double>(landmarks.size());
  return static_cast<int>(landmarks.size()) >= options.static_min_views &&
         static_cast<double>(near) >= options.static_share * views;
}

}  // namespace

TrackTruth SummariseTrack(const std::vector<LabelledView>& views, const KittiOptions& options) {
  std::vector<Landmark> in_world;
  for (const LabelledView& view : views) {
    in_world.push_back(Transform(view.world_from_camera, view.landmark_in_camera));
  }
  TrackTruth truth;
  truth.landmark_in_world = MedianLandmark(in_world);
  truth.is_static = IsStatic(in_world, truth.landmark_in_world.Centre(), options);
  if (!truth.is_static) truth.landmark_in_world = in_world.front();
  const Landmark& landmark = truth.landmark_in_world;
  const Eigen::Vector3d up = landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
  truth.plane_in_world = {up, landmark.half_axes.z() - up.dot(landmark.Centre())};
  return truth;
}

}  // namespace soslam
