// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/doubts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "artefact/json_file.h"
#include "base/error.h"
#include "base/paths.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kSigmas95 = 1.96;  // half an interval of 95 %, standard deviations

// True if the centre may be farther off than its body reaches, along a principal axis of its
// covariance.
bool IsPlaceUncertain(const Landmark& landmark, const Eigen::Matrix3d& covariance_of_centre) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance_of_centre);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = eigen.eigenvectors().col(i);
    const double reach = axis.dot(FindSupportPoint(landmark, axis).point - landmark.Centre());
    if (kSigmas95 * std::sqrt(std::max(0.0, eigen.eigenvalues()(i))) > reach) return true;
  }
  return false;
}

std::vector<std::string> UncertainSizes(const Covariance9& covariance) {
  constexpr std::array kNames = {"depth", "width", "height"};  // along x, y, z
  std::vector<std::string> names;
  for (int axis = 0; axis < 3; ++axis) {
    if (kSigmas95 * std::sqrt(covariance(6 + axis, 6 + axis)) > std::numbers::ln2) {
      names.emplace_back(kNames.at(static_cast<size_t>(axis)));
    }
  }
  return names;
}

// The sightings of each object, by its id.
std::map<int, Sightings> ReadSightings(const fs::path& associations) {
  if (!Exists(associations)) return {};
  const json document = ReadArtefact(associations, "associations");
  const json& tracks = document.at("tracks");
  std::map<int, Sightings> sightings;
  for (const json& object : document.at("objects")) {
    const auto track = object.at("track").get<size_t>();
    if (track >= tracks.size()) {
      throw InputError(fmt::format("{}: found track {} of {}; expected one in the list",
                                   associations.string(), track, tracks.size()));
    }
    const json& in_sight = tracks[track].at("frames_in_sight");
    if (in_sight.is_null()) continue;
    sightings[object.at("object").get<int>()] = {object.at("detections").get<int>(),
                                                 in_sight.get<int>()};
  }
  return sightings;
}

}  // namespace

std::string DoubtsInWords(const ObjectEstimate& estimate,
                          const std::optional<Sightings>& sightings) {
  std::vector<std::string> doubts;
  if (sightings && 2 * sightings->frames < sightings->frames_in_sight) {
    doubts.push_back(fmt::format("seen in only {} of the {} images that should show it",
                                 sightings->frames, sightings->frames_in_sight));
  }
  if (estimate.landmark_in_world && estimate.covariance) {
    const Covariance9& covariance = *estimate.covariance;
    if (IsPlaceUncertain(*estimate.landmark_in_world, covariance.block<3, 3>(3, 3))) {
      doubts.emplace_back("it may stand beside its outline");
    }
    const std::vector<std::string> sizes = UncertainSizes(covariance);
    if (!sizes.empty()) {
      doubts.push_back(
          fmt::format("its {} may be half or twice as large", fmt::join(sizes, " and ")));
    }
  }
  return fmt::format("{}", fmt::join(doubts, "; "));
}

std::vector<std::string> DoubtsOfMap(const fs::path& folder, const MapEstimate& map,
                                     const Sequence& sequence) {
  const std::map<int, Sightings> sightings = ReadSightings(folder / "associations.json");
  std::vector<std::string> doubts;
  for (const ObjectEstimate& estimate : map.objects) {
    const auto found =
        sightings.find(sequence.objects[static_cast<size_t>(estimate.object_index)].id);
    doubts.push_back(DoubtsInWords(
        estimate, found == sightings.end() ? std::nullopt : std::optional(found->second)));
  }
  return doubts;
}

}  // namespace soslam
