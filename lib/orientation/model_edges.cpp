// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/model_edges.h"

#include <cmath>
#include <numbers>

namespace soslam {
namespace {

// Up to this shape exponent an object has edges of its own, beyond it only a silhouette.
constexpr double kMaxEdgyExponent = 1.3;
constexpr int kOutlineDirections = 90;

class PointSampler {
 public:
  PointSampler(const Camera& camera, const Landmark& landmark_in_camera, double spacing_px)
      : camera_(camera), landmark_(landmark_in_camera), spacing_px_(spacing_px) {}

  // Adds points along a straight segment, each in the middle of one of equal parts.
  void AddSegment(const Eigen::Vector3d& unit_start, const Eigen::Vector3d& unit_end) {
    const auto start = Project(unit_start);
    const auto end = Project(unit_end);
    if (!start || !end) return;
    const double length = (*end - *start).norm();
    // A segment shorter than the spacing carries its fraction of a point over to the next ones.
    carried_ += length / spacing_px_;
    const int count = static_cast<int>(carried_);
    carried_ -= count;
    for (int i = 0; i < count; ++i) {
      const double t = (i + 0.5) / count;
      points.push_back({unit_start + t * (unit_end - unit_start), (*end - *start) / length});
    }
  }

  std::vector<ModelPoint> points;

 private:
  std::optional<Eigen::Vector2d> Project(const Eigen::Vector3d& in_unit_body) const {
    return camera_.Project(landmark_.frame_from_object *
                           landmark_.half_axes.cwiseProduct(in_unit_body));
  }

  const Camera& camera_;
  const Landmark& landmark_;
  double spacing_px_;
  double carried_ = 0.0;
};

void AddCuboidEdges(const Eigen::Vector3d& camera_in_unit_body, PointSampler* sampler) {
  for (int along = 0; along < 3; ++along) {
    const int i = (along + 1) % 3;
    const int j = (along + 2) % 3;
    for (const double sign_i : {-1.0, 1.0}) {
      for (const double sign_j : {-1.0, 1.0}) {
        const bool visible =
            sign_i * camera_in_unit_body[i] > 1.0 || sign_j * camera_in_unit_body[j] > 1.0;
        if (!visible) continue;
        Eigen::Vector3d start;
        start[along] = -1.0;
        start[i] = sign_i;
        start[j] = sign_j;
        Eigen::Vector3d end = start;
        end[along] = 1.0;
        sampler->AddSegment(start, end);
      }
    }
  }
}

void AddOutline(const Camera& camera, const Landmark& landmark, PointSampler* sampler) {
  const Rigid3d object_from_camera = landmark.frame_from_object.Inverse();
  std::vector<Eigen::Vector3d> contacts;
  Eigen::Vector3d last = landmark.Centre();
  for (int i = 0; i < kOutlineDirections; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kOutlineDirections;
    const auto end =
        FindSilhouettePoint(camera, landmark, {std::cos(angle), std::sin(angle)}, last);
    if (!end) return;
    last = end->point;
    contacts.push_back((object_from_camera * last).cwiseQuotient(landmark.half_axes));
  }
  for (size_t i = 0; i < contacts.size(); ++i) {
    sampler->AddSegment(contacts[i], contacts[(i + 1) % contacts.size()]);
  }
}

}  // namespace

std::vector<ModelPoint> VisibleModelPoints(const Camera& camera, const Landmark& landmark_in_camera,
                                           double spacing_px) {
  if (!IsInFront(landmark_in_camera)) return {};
  PointSampler sampler(camera, landmark_in_camera, spacing_px);
  if (landmark_in_camera.shape_exponent <= kMaxEdgyExponent) {
    AddCuboidEdges(landmark_in_camera.frame_from_object.Inverse().translation.cwiseQuotient(
                       landmark_in_camera.half_axes),
                   &sampler);
  } else {
    AddOutline(camera, landmark_in_camera, &sampler);
  }
  return std::move(sampler.points);
}

}  // namespace soslam
