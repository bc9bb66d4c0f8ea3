// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/upright_observation.h"

#include "initialisation/upright.h"

namespace soslam {

UprightObservation MakeUprightObservation(const Sequence& sequence, const Detection& detection,
                                          const ShapePrior& prior, const UprightOptions& options) {
  return {sequence.CameraOf(detection),
          BoxEdges(sequence.CameraOf(detection), detection.box, detection.is_bound,
                   options.detection_sigma_fraction),
          detection.plane_in_camera,
          prior,
          WorldAxisInCamera(sequence, detection),
          options.axes_weight};
}

Eigen::Vector3d WorldAxisInCamera(const Sequence& sequence, const Detection& detection) {
  const auto& object = sequence.objects[static_cast<size_t>(detection.object_index)];
  const Plane& plane = sequence.planes[static_cast<size_t>(object.plane_index)].plane_in_world;
  const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
  return frame.world_from_camera.rotation.conjugate() * WorldAxis(plane);
}

}  // namespace soslam
