// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>

#include "association/options.h"
#include "model/sequence.h"

namespace soslam {

// Where up is in a world without support planes, as cameras are held.
struct UpEstimate {
  Eigen::Vector3d up_in_world;
  // Of the rotation vector that turns it to where it really is (rad^2, world axes); zero about
  // itself.
  Eigen::Matrix3d covariance;
};

// By segment, each with a world of its own.
std::map<int, UpEstimate> UpOfSegments(const Sequence& sequence, const AssociateOptions& options);

}  // namespace soslam
