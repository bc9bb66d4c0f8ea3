// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/upright_observation.h"

#include <memory>

namespace soslam {

UprightObservation MakeUprightObservation(const Sequence& sequence, const Detection& detection,
                                          const ShapePrior& prior, const UprightOptions& options) {
  return {sequence.CameraOf(detection),
          BoxEdges(sequence.CameraOf(detection), detection.box, detection.is_one_sided,
                   options.detection_sigma_fraction, prior.edge_bias),
          detection.plane_in_camera,
          prior,
          SceneAxisInCamera(sequence, detection),
          options.axes_weight};
}

LandmarkCosts ObservationTerms(const UprightObservation& observation,
                               const Landmark& start_in_camera) {
  const Plane& plane = observation.plane_in_camera;
  LandmarkCosts terms;
  terms.push_back(std::make_unique<BoxTerm>(observation.edges, start_in_camera));
  terms.push_back(std::make_unique<RatioTerm>(observation.prior));
  if (observation.scene_axis_in_camera) {
    terms.push_back(std::make_unique<AxisTerm>(plane, *observation.scene_axis_in_camera,
                                               observation.axes_weight));
  }
  if (observation.yaw_prior) {
    terms.push_back(std::make_unique<YawTerm>(plane, *observation.yaw_prior));
  }
  if (observation.points) {
    const PointEvidence& evidence = *observation.points;
    terms.push_back(std::make_unique<PointCost>(evidence.points, start_in_camera, evidence.size_m,
                                                evidence.options, evidence.weight));
  }
  return terms;
}

std::optional<Eigen::Vector3d> SceneAxisInCamera(const Sequence& sequence,
                                                 const Detection& detection) {
  const auto plane = static_cast<size_t>(sequence.ObjectOf(detection).plane_index);
  const std::optional<Eigen::Vector3d>& axis = sequence.planes[plane].scene_axis_in_world;
  if (!axis) return std::nullopt;
  return sequence.FrameOf(detection).world_from_camera.rotation.conjugate() * *axis;
}

}  // namespace soslam
