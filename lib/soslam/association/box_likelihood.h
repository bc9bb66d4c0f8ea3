// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/association/fit_track.h"
#include "soslam/association/options.h"
#include "soslam/constraints/tangency.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/landmark.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Odometry drift as a random walk: every motion between consecutive frames has an independent
// error, a small rotation and a translation, both isotropic.
class Drift {
 public:
  Drift(const std::vector<Frame>& frames, double rotation_sigma_rad, double translation_sigma_m);

  // Covariance (m^2, world axes) of a point's position relative to the camera of one frame, when it
  // is exactly known relative to the camera of the other. A rotation error moves the point by its
  // lever arm from the camera position at that time.
  Eigen::Matrix3d PointCovariance(int frame_index, int other_frame_index,
                                  const Eigen::Vector3d& point_in_world) const;

 private:
  double rotation_variance_;
  double translation_variance_;
  Eigen::Vector3d origin_;  // of the positions summed below
  // Prefix sums of camera positions and of their outer products: element i covers the frames before
  // i.
  std::vector<Eigen::Vector3d> position_sums_;
  std::vector<Eigen::Matrix3d> product_sums_;
};

// Fit of an object's predicted outline to a detection's box.
struct BoxMatch {
  double overlap = 0.0;   // intersection over union of the box and the outline box
  double distance = 0.0;  // Mahalanobis distance of the box to the expected one
  // Edge (left, top, right, bottom) that does not belong to the object, if this is more likely.
  std::optional<BoxSide> cut_edge;
  double cost = 0.0;  // -2 log of the probability density of the box (1 / px^4)
};

// Predicted pose and outline box of an object in a frame.
struct Prediction {
  Rigid3d camera_from_world;
  Landmark landmark_in_camera;
  Box outline;
  // Covariance of the outward offsets of the edges (left, top, right, bottom), px^2.
  Eigen::Matrix4d outline_covariance;
  bool feet_are_hidden = false;  // see FittedObject
  EdgeBias edge_bias = {};       // of boxes of the object's label
};

// Likelihood of a detected box given an object. The four edges are normally distributed about the
// outline of the object's landmark; the covariance sums the detector's edge noise, the landmark's
// covariance, and the odometry drift since the object was last seen. Any one edge may be cut off;
// its position is then uniform over the extent of the outline. Keeps references.
class BoxLikelihood {
 public:
  BoxLikelihood(const Sequence& sequence, const AssociateOptions& options);

  // Empty when the landmark is not entirely in front of the camera. `known_frame_index`: the frame
  // of the same segment in which the object was seen and from which drift is counted. `bias`: of
  // boxes of the object's label.
  std::optional<Prediction> Predict(const FittedObject& object, int known_frame_index,
                                    int frame_index, const EdgeBias& bias = {}) const;

  // Empty when the box is so far off that CostOfAnyBox is certainly lower.
  std::optional<BoxMatch> Match(const Prediction& prediction, const Detection& detection) const;

  // Cost of the box of an unseen object: uniform over all positions and sizes in the image.
  double CostOfAnyBox(const Detection& detection) const;

 private:
  const Sequence& sequence_;
  const AssociateOptions& options_;
  Drift drift_;
};

}  // namespace soslam
