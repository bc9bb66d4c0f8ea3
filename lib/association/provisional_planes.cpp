// SPDX-License-Identifier: BSD-3-Clause
#include "association/provisional_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "base/error.h"
#include "initialisation/yaw_sweep.h"
#include "planes/camera_attitude.h"

namespace soslam {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

// A plane's height (m, along up) as one detection has it.
struct HeightVote {
  double height;
  double weight;
};

double WeightedMedian(std::vector<HeightVote> votes) {
  std::ranges::sort(votes, {}, &HeightVote::height);
  double half = 0.0;
  for (const HeightVote& vote : votes) half += 0.5 * vote.weight;
  for (const HeightVote& vote : votes) {
    half -= vote.weight;
    if (half <= 0.0) return vote.height;
  }
  return votes.back().height;
}

// All that stands on one plane and is seen from one camera grows with the camera's height above the
// plane. So the body that suits the box on a plane 1 m below says how far the plane really is.
std::optional<HeightVote> VoteOf(const Sequence& sequence, const Detection& detection,
                                 ShapePrior prior, const Eigen::Vector3d& up,
                                 const AssociateOptions& options) {
  const LogNormal height = *prior.height_m;
  prior.height_m.reset();
  const Rigid3d& world_from_camera = sequence.FrameOf(detection).world_from_camera;
  const double camera_height = up.dot(world_from_camera.translation);
  UprightObservation observation = MakeUprightObservation(
      sequence, detection, prior,
      {options.box_sigma_fraction, /*axes_weight=*/0.0, options.yaw_grid_deg});
  observation.plane_in_camera =
      Transform(world_from_camera.Inverse(), Plane{up, 1.0 - camera_height});
  const YawObjective objective = BoxObjective(observation);
  const auto optima = LocalOptima(
      observation, objective, SweepYaw(observation, objective, options.yaw_grid_deg * kRadians), 1);
  if (optima.empty()) return std::nullopt;
  const double distance = height.median / (2.0 * optima.front().landmark.half_axes.z());
  // Of flat things the box shows length and width, from which the height follows by the ratio.
  const double log_sigma =
      std::hypot(height.log_sigma, prior.log_sigma.norm() / std::numbers::sqrt2);
  return HeightVote{camera_height - distance, 1.0 / (distance * log_sigma)};
}

// The detections of each segment whose label has a height.
std::map<int, std::vector<int>> VotersBySegment(const Sequence& sequence,
                                                const SemanticTable& table) {
  std::map<int, std::vector<int>> voters;
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& detection = sequence.detections[i];
    std::vector<int>& of_segment = voters[sequence.FrameOf(detection).segment];
    const auto prior = table.Find(sequence.ObjectOf(detection).label);
    if (prior && prior->height_m) of_segment.push_back(static_cast<int>(i));
  }
  return voters;
}

// Up in the world of a segment, by how its cameras are held.
Eigen::Vector3d UpOfSegment(const Sequence& sequence, int segment,
                            const AssociateOptions& options) {
  constexpr double kRollSigma = 5.0 * kRadians;  // as soslam-planes has them
  constexpr double kPitchSigma = 30.0 * kRadians;
  std::vector<Rigid3d> poses;
  for (const Frame& frame : sequence.frames) {
    if (frame.segment == segment) poses.push_back(frame.world_from_camera);
  }
  return AttitudeOf(poses, kRollSigma, kPitchSigma, options.view_correlation_deg * kRadians)
      .up_in_world;
}

double HeightOfPlane(const Sequence& sequence, const Eigen::Vector3d& up,
                     const std::vector<int>& voters, const SemanticTable& table,
                     const AssociateOptions& options) {
  constexpr size_t kVoters = 200;
  std::vector<HeightVote> votes;
  for (const int index : SpreadOver(voters, kVoters)) {
    const Detection& detection = sequence.detections[static_cast<size_t>(index)];
    const auto vote =
        VoteOf(sequence, detection, *table.Find(sequence.ObjectOf(detection).label), up, options);
    if (vote) votes.push_back(*vote);
  }
  if (votes.empty()) {
    throw NothingUsableError(fmt::format(
        "{}: no planes are known, nor the height of anything that is detected; expected "
        "planes.json, or a semantic table with heights of its labels",
        sequence.name));
  }
  return WeightedMedian(std::move(votes));
}

}  // namespace

Sequence OnProvisionalPlanes(Sequence sequence, const SemanticTable& table,
                             const AssociateOptions& options) {
  const auto voters_by_segment = VotersBySegment(sequence, table);
  std::map<int, int> plane_of_segment;
  for (const auto& [segment, voters] : voters_by_segment) {
    plane_of_segment[segment] = static_cast<int>(sequence.planes.size());
    sequence.planes.push_back({segment, {UpOfSegment(sequence, segment, options), 0.0}});
  }
  for (Object& object : sequence.objects) object.plane_index = 0;  // also of those never detected
  for (const Detection& detection : sequence.detections) {
    sequence.objects[static_cast<size_t>(detection.object_index)].plane_index =
        plane_of_segment.at(sequence.FrameOf(detection).segment);
  }
  for (SupportPlane& plane : sequence.planes) {
    Plane& in_world = plane.plane_in_world;
    in_world.offset =
        -HeightOfPlane(sequence, in_world.normal, voters_by_segment.at(plane.id), table, options);
  }
  for (Detection& detection : sequence.detections) {
    const auto plane = static_cast<size_t>(sequence.ObjectOf(detection).plane_index);
    detection.plane_in_camera = Transform(sequence.FrameOf(detection).world_from_camera.Inverse(),
                                          sequence.planes[plane].plane_in_world);
  }
  return sequence;
}

Sequence WithoutPlanes(Sequence sequence) {
  sequence.planes.clear();
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  return sequence;
}

}  // namespace soslam
