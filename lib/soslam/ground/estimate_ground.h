// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "soslam/geometry/similarity.h"
#include "soslam/ground/options.h"
#include "soslam/ground/up_hypotheses.h"
#include "soslam/model/map_points.h"
#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"
#include "soslam/model/world.h"
#include "soslam/planes/planes_estimate.h"

namespace soslam {

// The sequence without planes, with its estimated poses in the target world. Ground truth stays.
Sequence Transformed(const Similarity& target_from_source, Sequence sequence);

std::vector<MapPoint> Transformed(const Similarity& target_from_source,
                                  std::vector<MapPoint> points);

// Up, scale and horizontal planes of points of a world that has neither up nor scale.
struct GroundEstimate {
  Similarity output_from_input;  // the output's world has z up, in metres
  Eigen::Vector3d up_in_input = Eigen::Vector3d::UnitZ();
  Eigen::Matrix2d tilt_covariance = Eigen::Matrix2d::Zero();  // of up, by UpByTurns (rad^2)
  double tilt_sigma = 0.0;                                    // of up, both tilts together (rad)
  double up_probability = 1.0;           // that up is within kTrustedUpDeg of the true one
  double cameras_tilt_sigma = 0.0;       // of up from the cameras and vertical edges alone (rad)
  double tilt_to_cameras = 0.0;          // from that up to the final one (rad)
  UpEstimate up_of_cameras;              // how they are held, and how probable other ways are
  bool cameras_are_turned = false;       // in many ways: only planes tell up
  bool verticals = false;                // vertical edges were used
  std::optional<ScalePosterior> scale;   // of metres per unit of the input
  std::vector<KnownScale> known_scales;  // by two options and measured objects, of the same unit
  std::optional<ScalePosterior> scale_of_objects;  // by labels alone
  std::vector<EstimatedPlane> planes;              // of the output
  std::vector<int> points_on_planes;
  int planes_of_points = 0;  // before planes without an object were dropped
  int points = 0;
  std::vector<WorldReport::ObjectRow> objects;

  // How many objects have the height of their label at the scale, which rests on them.
  int AgreeingObjects() const {
    return static_cast<int>(std::ranges::count_if(objects, &WorldReport::ObjectRow::TellsByLabel));
  }

  // The sum of the weights of these.
  double IndependentObjects() const {
    double sum = 0.0;
    for (const WorldReport::ObjectRow& object : objects) {
      if (object.TellsByLabel()) sum += object.weight;
    }
    return sum;
  }
};

// Estimates up, scale and planes from sparse points, boxes and the way cameras are held.
// The result does not depend on the frame and unit of the input. `views`: line segments per frame;
// empty to not use vertical edges. Of edits, sizes tell the scale. At least one frame, all of one
// segment. Throws InputError for edits that fit no box.
GroundEstimate EstimateGround(const Sequence& sequence, const std::vector<MapPoint>& points,
                              const std::vector<SegmentView>& views,
                              const std::vector<TurnedImage>& turned_images,
                              const PairEvidence& pairs, const Edits& edits,
                              const SemanticTable& table, const GroundOptions& options,
                              int threads);

// The sequence in the output's world, with what was found as Sequence::ground; support planes are
// not known yet. Its scale is an estimate, so that evaluation finds the true one apart from other
// errors.
Sequence WithGround(const Sequence& sequence, const GroundEstimate& estimate);

}  // namespace soslam
