// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/model_edges.h"

#include <optional>

#include "geometry/wireframe.h"

namespace soslam {
namespace {

// Up to this shape exponent an object has edges of its own, beyond it only a silhouette.
constexpr double kMaxEdgyExponent = 1.3;

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
    return camera_.Project(PointAt(landmark_, in_unit_body));
  }

  const Camera& camera_;
  const Landmark& landmark_;
  double spacing_px_;
  double carried_ = 0.0;
};

void AddCuboidEdges(const Eigen::Vector3d& camera_in_unit_body, PointSampler* sampler) {
  for (const LineSegment3& edge : UnitCuboidEdges()) {
    if (IsVisibleCuboidEdge(edge, camera_in_unit_body)) sampler->AddSegment(edge[0], edge[1]);
  }
}

void AddOutline(const Camera& camera, const Landmark& landmark, PointSampler* sampler) {
  const Rigid3d object_from_camera = landmark.frame_from_object.Inverse();
  std::vector<Eigen::Vector3d> contacts = SilhouettePoints(camera, landmark);
  for (Eigen::Vector3d& contact : contacts) {
    contact = (object_from_camera * contact).cwiseQuotient(landmark.half_axes);
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
    AddCuboidEdges(CameraInUnitBody(landmark_in_camera), &sampler);
  } else {
    AddOutline(camera, landmark_in_camera, &sampler);
  }
  return std::move(sampler.points);
}

}  // namespace soslam
