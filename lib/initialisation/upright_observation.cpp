// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/upright_observation.h"

#include <memory>

namespace soslam {

UprightObservation MakeUprightObservation(const Sequence& sequence, const Detection& detection,
                                          const ShapePrior& prior, const UprightOptions& options) {
  return {sequence.CameraOf(detection),
          BoxEdges(sequence.CameraOf(detection), detection.box, detection.is_bound,
                   options.detection_sigma_fraction, prior.edge_bias),
          detection.plane_in_camera,
          prior,
          WorldAxisInCamera(sequence, detection),
          options.axes_weight};
}

LandmarkCosts ObservationTerms(const UprightObservation& observation,
                               const Landmark& start_in_camera) {
  const Plane& plane = observation.plane_in_camera;
  LandmarkCosts terms;
  terms.push_back(std::make_unique<BoxTerm>(observation.edges, start_in_camera));
  terms.push_back(std::make_unique<RatioTerm>(observation.prior));
  terms.push_back(
      std::make_unique<AxisTerm>(plane, observation.world_axis_in_camera, observation.axes_weight));
  if (observation.yaw_prior) {
    terms.push_back(std::make_unique<YawTerm>(plane, *observation.yaw_prior));
  }
  return terms;
}

Eigen::Vector3d WorldAxisInCamera(const Sequence& sequence, const Detection& detection) {
  const auto& object = sequence.objects[static_cast<size_t>(detection.object_index)];
  const Plane& plane = sequence.planes[static_cast<size_t>(object.plane_index)].plane_in_world;
  const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
  return frame.world_from_camera.rotation.conjugate() * WorldAxis(plane);
}

}  // namespace soslam
