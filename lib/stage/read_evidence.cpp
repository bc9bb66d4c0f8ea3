// SPDX-License-Identifier: BSD-3-Clause
#include "stage/read_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "artefact/files.h"
#include "base/error.h"

namespace soslam {

EdgesOfSequence::EdgesOfSequence(const Sequence& sequence, const StageFiles& files)
    : sequence_(sequence), files_(files), reader_(files.at("edges")) {}

EdgeMaps EdgesOfSequence::Read(const Frame& frame) const {
  EdgeMaps maps = reader_.Read(frame.id);
  const Camera& camera = sequence_.CameraOf(frame);
  if (maps.grey.cols != camera.width || maps.grey.rows != camera.height) {
    throw InputError(fmt::format(
        "{}: frame {} has {} x {} pixels; expected {} x {}, as its camera in {}: were the edges "
        "made from another sequence?",
        files_.at("edges").string(), frame.id, maps.grey.cols, maps.grey.rows, camera.width,
        camera.height, files_.at("sequence").string()));
  }
  return maps;
}

void CheckHasPoints(const PointOptions& options, const StageFiles& files) {
  if (options.point_evidence && !files.contains("points")) {
    throw SettingsError("point_evidence = true needs --points FILE; found none");
  }
}

std::vector<MapPoint> ReadPointsOf(const Sequence& sequence, const StageFiles& files) {
  std::vector<MapPoint> points = ReadPoints(files.at("points"));
  std::set<int> frame_ids;
  for (const Frame& frame : sequence.frames) frame_ids.insert(frame.id);
  const auto is_seen = [&](const MapPoint& point) {
    return std::ranges::any_of(point.observations, [&](const PointObservation& observation) {
      return frame_ids.contains(observation.frame_id);
    });
  };
  if (!points.empty() && std::ranges::none_of(points, is_seen)) {
    throw InputError(fmt::format(
        "{}: observation_frame: none of {} points is seen in a frame of {}; expected ids of its {} "
        "frames: were the points made from another dataset?",
        files.at("points").string(), points.size(), files.at("sequence").string(),
        sequence.frames.size()));
  }
  return points;
}

}  // namespace soslam
