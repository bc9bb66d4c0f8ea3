// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "soslam/artefact/files.h"
#include "soslam/model/describe_estimates.h"

namespace soslam {

constexpr const char* kLandmarksKind = "landmarks";
constexpr const char* kMapKind = "map";

LandmarkEstimates ReadLandmarks(const std::filesystem::path& path, const Sequence& sequence) {
  return ReadDescribed<LandmarkEstimates>(path, kLandmarksKind, &sequence).body;
}

void WriteLandmarks(const std::filesystem::path& path, const LandmarkEstimates& estimates,
                    const Sequence& sequence, const ArtefactInfo& info) {
  WriteArtefact(path, kLandmarksKind, info, DescribedToJson(estimates, &sequence));
}

MapEstimate ReadMap(const std::filesystem::path& path, const Sequence& sequence) {
  return ReadDescribed<MapEstimate>(path, kMapKind, &sequence).body;
}

void WriteMap(const std::filesystem::path& path, const MapEstimate& map, const Sequence& sequence,
              const ArtefactInfo& info) {
  if (map.world_from_camera.size() != sequence.frames.size() ||
      map.planes_in_world.size() != sequence.planes.size()) {
    throw std::logic_error("the map has other frames or planes than its sequence");
  }
  WriteArtefact(path, kMapKind, info, DescribedToJson(map, &sequence));
}

}  // namespace soslam
