// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <vector>

#include "soslam/artefact/files.h"
#include "soslam/artefact/options_json.h"
#include "soslam/cli/command_line.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/stage/stages.h"
#include "soslam/stage/track_points.h"

namespace soslam {
void RunTrack(const TrackOptions& options, const StageFiles& files, int threads) {
  const std::filesystem::path& sequence_file = files.at("sequence");
  const Sequence sequence = ReadSequence(sequence_file, PlaneNeed::kNotNeeded);
  const std::vector<FrameImage> images = FrameImages(sequence, files.at("dataset"), sequence_file);
  ArtefactInfo info = {
      .settings = OptionsToJson(options), .inputs = {sequence_file}, .stage = "track"};
  for (const FrameImage& image : images) info.inputs.push_back(image.path);
  const TrackedPoints tracked = TrackPoints(sequence, images, options, threads);
  info.findings = tracked.findings;
  ReportFindings("track", info.findings);
  WritePoints(files.at("output"), tracked.points, info);
  const std::vector<MapPoint>& points = tracked.points;
  if (points.empty()) {
    fmt::print("{}: no point from {} tracks\n", sequence.name, tracked.tracks);
    return;
  }
  const auto views = [](const MapPoint& point) {
    return static_cast<double>(point.observations.size());
  };
  fmt::print(
      "{}: {} points from {} tracks, median reprojection error {:.2f} px, each in {:.0f} "
      "images (median)\n",
      sequence.name, points.size(), tracked.tracks,
      *MedianOf(CollectValues(points, &MapPoint::reprojection_error_px)),
      *MedianOf(CollectValues(points, views)));
}

}  // namespace soslam
