// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <vector>

#include "soslam/model/sequence.h"

namespace soslam {

// Image point of a sparse point.
struct PointObservation {
  int frame_id = 0;  // Frame::id: the 0-based row in the dataset's image list
  // (0, 0) is the centre of the top-left pixel. In the image as it is stored, lens distortion
  // included; estimates take points without it
  // (WithoutDistortion in image/undistorted_points.h).
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

// Sparse point of structure from motion.
struct MapPoint {
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();
  double reprojection_error_px = 0.0;  // mean over its observations; 0 where it is not known
  std::vector<PointObservation> observations;
};

// A point of the scene that several images show, of unknown position.
struct PointTrack {
  std::vector<PointObservation> observations;  // by frame, one of each
};

// Index in Sequence::frames of the frame that observes a point; none where the sequence does not
// have it.
inline std::optional<size_t> FindFrameIndex(const Sequence& sequence,
                                            const PointObservation& observation) {
  const auto frame =
      std::ranges::lower_bound(sequence.frames, observation.frame_id, {}, &Frame::id);
  if (frame == sequence.frames.end() || frame->id != observation.frame_id) return std::nullopt;
  return static_cast<size_t>(frame - sequence.frames.begin());
}

}  // namespace soslam
