// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/inspection/doubts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "soslam/artefact/files.h"
#include "soslam/base/paths.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/model/segments.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// True if the centre may be off by more than the body's reach from it, along a principal axis of
// the horizontal part of the centre's covariance.
bool IsPlaceUncertain(const Landmark& landmark, const Eigen::Matrix3d& covariance_of_centre,
                      const Eigen::Vector3d& up_in_world) {
  Eigen::Matrix<double, 3, 2> horizontal;
  horizontal.col(0) = up_in_world.unitOrthogonal();
  horizontal.col(1) = up_in_world.cross(horizontal.col(0));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(horizontal.transpose() *
                                                             covariance_of_centre * horizontal);
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d axis = horizontal * eigen.eigenvectors().col(i);
    const double reach = axis.dot(FindSupportPoint(landmark, axis).point - landmark.Centre());
    const double sigma = std::sqrt(std::max(0.0, eigen.eigenvalues()(i)));
    if (kHalfInterval95 * sigma > reach) return true;
  }
  return false;
}

}  // namespace

std::string RarelyDetectedInWords(int frames, int frames_in_sight) {
  return fmt::format("detected in only {} of the {} images that should show it", frames,
                     frames_in_sight);
}

std::string DoubtsInWords(const ObjectEstimate& estimate, const Sightings& sightings,
                          const Eigen::Vector3d& up_in_world) {
  std::vector<std::string> doubts;
  if (2 * sightings.frames < sightings.frames_in_sight) {
    doubts.push_back(RarelyDetectedInWords(sightings.frames, sightings.frames_in_sight));
  }
  if (estimate.landmark_in_world && estimate.covariance) {
    const Covariance9& covariance = *estimate.covariance;
    if (IsPlaceUncertain(*estimate.landmark_in_world, covariance.block<3, 3>(3, 3), up_in_world)) {
      doubts.emplace_back("it may stand beside its outline");
    }
    constexpr std::array kNames = {"depth", "width", "height"};  // along x, y, z
    constexpr double kTwice = 1.0;  // half an interval that includes twice the size
    std::vector<std::string> sizes;
    for (int axis = 0; axis < 3; ++axis) {
      if (HalfInterval95(std::sqrt(covariance(6 + axis, 6 + axis))) > kTwice) {
        sizes.emplace_back(kNames.at(static_cast<size_t>(axis)));
      }
    }
    if (!sizes.empty()) {
      doubts.push_back(
          fmt::format("its {} may be half or twice as large", fmt::join(sizes, " and ")));
    }
  }
  return fmt::format("{}", fmt::join(doubts, "; "));
}

std::vector<std::string> DoubtsOfMap(const fs::path& folder, const MapEstimate& map,
                                     const Sequence& sequence) {
  std::map<int, Sightings> sightings;  // by id of the object
  if (const fs::path file = folder / "associations.json"; Exists(file)) {
    const Associations associations = ReadAssociations(file).body;
    for (const Associations::ObjectRow& object : associations.objects) {
      const std::optional<int> in_sight = associations.tracks[object.track].frames_in_sight;
      if (in_sight) sightings[object.object] = {object.detections, *in_sight};
    }
  }
  const std::vector<std::optional<int>> segments = SegmentsOfObjects(sequence);
  std::map<int, Eigen::Vector3d> up_of_segment;
  std::vector<std::string> doubts;
  for (const ObjectEstimate& estimate : map.objects) {
    const int segment = segments[estimate.object_index].value_or(0);
    if (!up_of_segment.contains(segment)) up_of_segment[segment] = UpOfSegment(sequence, segment);
    doubts.push_back(DoubtsInWords(estimate, sightings[sequence.objects[estimate.object_index].id],
                                   up_of_segment[segment]));
  }
  return doubts;
}

std::string DistrustOfMap(const WorldReport* world, const Sequence& sequence) {
  constexpr double kLeast = 0.5;
  std::vector<std::string> reasons;
  const size_t placed = sequence.frames.size(), all = placed + sequence.images_without_pose.size();
  if (2 * placed < all) reasons.push_back(fmt::format("{} of {} photos have a place", placed, all));
  const double up = world == nullptr ? 1.0 : world->up.probability;
  const double scale = world == nullptr || !world->scale ? 1.0 : world->scale->probability;
  if (up * scale < kLeast) {
    reasons.push_back(
        fmt::format("up is right to {} degrees with a probability of {:.0f} %, the "
                    "scale to a factor of {} with {:.0f} %",
                    kTrustedUpDeg, 100.0 * up, kTrustedScale, 100.0 * scale));
  }
  return fmt::format("{}", fmt::join(reasons, ", "));
}

}  // namespace soslam
