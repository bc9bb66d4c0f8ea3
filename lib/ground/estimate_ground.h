// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/rigid3.h"
#include "ground/object_heights.h"
#include "ground/options.h"
#include "ground/scale_posterior.h"
#include "model/image_turns.h"
#include "model/map_points.h"
#include "model/semantic_table.h"
#include "model/sequence.h"
#include "planes/planes_estimate.h"
#include "planes/up_prior.h"

namespace soslam {

// Change of the world's frame and unit: rigid * (scale * point).
struct Similarity {
  double scale = 1.0;
  Rigid3d rigid;

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rigid * (scale * point); }
  Similarity operator*(const Similarity& other) const {
    return {
        scale * other.scale,
        {(rigid.rotation * other.rigid.rotation).normalized(), *this * other.rigid.translation}};
  }
};

// The sequence without planes, with its estimated poses in the target world. Ground truth stays.
Sequence Transformed(const Similarity& target_from_source, Sequence sequence);

std::vector<MapPoint> Transformed(const Similarity& target_from_source,
                                  std::vector<MapPoint> points);

// Result for one object: its most probable label and support.
struct GroundObject {
  std::string label;
  int plane = kNoPlane;  // index in GroundEstimate::planes
  int boxes = 0;
  std::optional<Eigen::Vector3d> centre_in_world;  // of the output; none where no body fits
  std::optional<double> height_m;
  std::optional<double> log_scale;  // by its label's height, of metres per unit of the input
  std::optional<double> log_sigma;
  double weight = 0.0;         // below 1 where its height is correlated with that of others
  double agreement = 0.0;      // probability that its height is right
  bool is_measured = false;    // edits give a size
  std::optional<double> pull;  // see ScalePosterior

  bool AgreesWithScale() const { return agreement >= 0.5; }
  bool TellsByLabel() const { return AgreesWithScale() && !is_measured; }
};

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
  std::vector<GroundObject> objects;

  // How many objects have the height of their label at the scale, which rests on them.
  int AgreeingObjects() const {
    return static_cast<int>(std::ranges::count_if(objects, &GroundObject::TellsByLabel));
  }

  // The sum of the weights of these.
  double IndependentObjects() const {
    double sum = 0.0;
    for (const GroundObject& object : objects) {
      if (object.TellsByLabel()) sum += object.weight;
    }
    return sum;
  }
};

// What a detector finds in a frame's image and in its turned copies (ImageTurns::Row).
struct TurnedImage {
  int frame_index;
  std::array<double, kQuarterTurns> scores;
};

// KnownScale::setting of an object whose size edits give.
inline constexpr const char* kSizeByHand = "edits";

// Estimates up, scale and planes from sparse points, boxes and the way cameras are held.
// The result does not depend on the frame and unit of the input. `views`: line segments per frame;
// empty to not use vertical edges. Of edits, sizes tell the scale. At least one frame, all of one
// segment. Throws InputError for edits that fit no box.
GroundEstimate EstimateGround(const Sequence& sequence, const std::vector<MapPoint>& points,
                              const std::vector<SegmentView>& views,
                              const std::vector<TurnedImage>& turned_images, const Edits& edits,
                              const SemanticTable& table, const GroundOptions& options,
                              int threads);

// The sequence in the output's world, with what was found as Sequence::ground; support planes are
// not known yet. Its scale is an estimate, so that evaluation finds the true one apart from other
// errors.
Sequence WithGround(const Sequence& sequence, const GroundEstimate& estimate);

}  // namespace soslam
