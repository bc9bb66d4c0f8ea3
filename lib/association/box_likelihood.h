// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "association/drift.h"
#include "association/fit_object.h"
#include "association/options.h"
#include "geometry/box.h"
#include "model/sequence.h"

namespace soslam {

// Fit of an object's predicted outline to a detection's box.
struct BoxMatch {
  double overlap = 0.0;   // intersection over union of the box and the outline box
  double distance = 0.0;  // Mahalanobis distance of the box to the expected one
  // Edge (left, top, right, bottom) that does not belong to the object, if this is more likely.
  std::optional<int> cut_edge;
  double cost = 0.0;  // -2 log of the probability density of the box (1 / px^4)
};

// Predicted pose and outline box of an object in a frame.
struct Prediction {
  Rigid3d camera_from_world;
  Landmark landmark_in_camera;
  Box outline;
  Eigen::Matrix3d drift_covariance;  // of the landmark's centre, m^2, world axes
  // Covariance of the outward offsets of the edges (left, top, right, bottom), px^2.
  Eigen::Matrix4d outline_covariance;
};

// Likelihood of a detected box given an object. The four edges are normally distributed about the
// outline of the object's landmark; the covariance sums the detector's edge noise, the landmark's
// covariance, and the odometry drift since the object was last seen. Any one edge may be cut off;
// its position is then uniform over the extent of the outline. Keeps references.
class BoxLikelihood {
 public:
  BoxLikelihood(const Sequence& sequence, const AssociateOptions& options);

  // None when the landmark is not entirely in front of the camera. `known_frame_index`: the frame
  // of the same segment in which the object was seen and from which drift is counted.
  std::optional<Prediction> Predict(const FittedObject& object, int known_frame_index,
                                    int frame_index) const;

  // None when the box is so far off that CostOfAnyBox is certainly lower.
  std::optional<BoxMatch> Match(const Prediction& prediction, const Detection& detection) const;

  // Cost of the box of an unseen object: uniform over all positions and sizes in the image.
  double CostOfAnyBox(const Detection& detection) const;

 private:
  const Sequence& sequence_;
  const AssociateOptions& options_;
  Drift drift_;
};

}  // namespace soslam
