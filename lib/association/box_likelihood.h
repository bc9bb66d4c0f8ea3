// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "association/drift.h"
#include "association/fit_object.h"
#include "association/options.h"
#include "geometry/box.h"
#include "model/sequence.h"

namespace soslam {

// How an object explains a detection's box.
struct Explanation {
  double overlap = 0.0;   // of the box and that of the landmark's outline
  double distance = 0.0;  // of the box from the expected one, in standard deviations (Mahalanobis)
  std::optional<int> cut_edge;  // left, top, right, bottom: not the object's, if this says more
  double cost = 0.0;            // -2 log of the probability density of the box (1 / px^4)
};

// Where an object is expected in a frame.
struct Prediction {
  Rigid3d camera_from_world;
  Landmark landmark_in_camera;
  Box outline;
  Eigen::Matrix3d drift_covariance;    // of the landmark's centre, m^2, world axes
  Eigen::Matrix4d outline_covariance;  // of how far its edges reach outwards, px^2
};

// The likelihood of boxes. About the outline of an object's landmark the four edges are normally
// distributed: with the spread of boxes about bodies, the landmark's own covariance, and what the
// odometry may have drifted since the object was last seen. Any one edge may be cut off, and is
// then anywhere over the extent of the outline. Keeps references.
class BoxLikelihood {
 public:
  BoxLikelihood(const Sequence& sequence, const AssociateOptions& options);

  // None when the landmark is not wholly in front of the camera. `known_frame_index`: of a frame of
  // the same segment in which the object was seen, that its landmark is good for.
  std::optional<Prediction> Predict(const FittedObject& object, int known_frame_index,
                                    int frame_index) const;

  // None when the box is so far off that CostOfAnyBox is certain to be less.
  std::optional<Explanation> Explain(const Prediction& prediction,
                                     const Detection& detection) const;

  // Of the box of an object that nothing is known of: anywhere in the image, of any size.
  double CostOfAnyBox(const Detection& detection) const;

 private:
  const Sequence& sequence_;
  const AssociateOptions& options_;
  Drift drift_;
};

}  // namespace soslam
