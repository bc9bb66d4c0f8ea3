// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/model/sequence.h"
#include "soslam/planes/up_prior.h"

namespace soslam {

// Direction, modulo quarter turns, along which the straight edges of a scene lie in the planes of
// this normal: edges of walls, furniture and what lies on it. A segment counts as parallel to the
// planes, unless it is the image of an edge along the normal, and with its length; cameras whose
// optical axes are closer than about `correlation_rad` count together as one. None if there is no
// direction that many more edges have than chance would give it.
std::optional<Eigen::Vector3d> SceneAxis(const Eigen::Vector3d& normal_in_world,
                                         const std::vector<SegmentView>& views,
                                         double correlation_rad);

// Sets SupportPlane::scene_axis_in_world of all planes that have none. The views are in the
// sequence's world.
void SetSceneAxes(const std::vector<SegmentView>& views, double correlation_rad,
                  Sequence* sequence);

}  // namespace soslam
