// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <vector>

#include "soslam/artefact/files.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/parallel.h"
#include "soslam/base/text.h"
#include "soslam/cli/command_line.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/image/box_colours.h"
#include "soslam/image/feature_matches.h"
#include "soslam/image/undistorted_points.h"
#include "soslam/model/occlusion.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"

namespace soslam {
void RunMatch(const MatchOptions& options, const StageFiles& files, int threads) {
  const std::filesystem::path& sequence_file = files.at("sequence");
  const Sequence sequence = ReadSequence(sequence_file, PlaneNeed::kNotNeeded);
  const std::vector<FrameImage> images = FrameImages(sequence, files.at("dataset"), sequence_file);
  ArtefactInfo info = {
      .settings = OptionsToJson(options), .inputs = {sequence_file}, .stage = "match"};
  std::vector<int> segments;
  for (const FrameImage& image : images) {
    info.inputs.push_back(image.path);
    segments.push_back(image.frame->segment);
  }
  const FrameImageReader reader(sequence);
  std::vector<FeatureView> views(images.size());
  ImageMatches found;
  found.colours.resize(sequence.detections.size(), BoxColours::Zero());
  ParallelFor("images", images.size(), threads, [&](size_t i) {
    const Frame& frame = *images[i].frame;
    views[i] = {sequence.CameraOf(frame), frame.world_from_camera,
                FindFeatures(reader.Read(images[i], cv::IMREAD_GRAYSCALE), options)};
    const cv::Mat colour = reader.Read(images[i], cv::IMREAD_COLOR);
    for (const Detection& detection :
         DetectionsIn(sequence, static_cast<int>(&frame - sequence.frames.data()))) {
      found.colours[&detection - sequence.detections.data()] = ColoursIn(colour, detection.box);
    }
  });
  const std::vector<std::pair<int, int>> pairs = ImagePairs(segments);
  std::vector<std::vector<FeatureMatch>> matches(pairs.size());
  ParallelFor("pairs", pairs.size(), threads, [&](size_t i) {
    matches[i] = MatchFeatures(views[pairs[i].first], views[pairs[i].second], options);
  });
  std::vector<PointTrack>& tracks = found.tracks;
  for (const FeatureTrack& track : JoinMatches(views, pairs, matches, options)) {
    PointTrack& stored = tracks.emplace_back();
    for (const FeatureTrack::Place& place : track.places) {
      stored.observations.push_back(
          StoredObservation(sequence, *images[place.image].frame, place.pixel));
    }
  }
  if (tracks.empty()) {
    info.findings = {{"no_shared_points", Severity::kWarning,
                      fmt::format("no two of {} share a point", Counted(images.size(), "image")),
                      "some",
                      "the images show little texture or have little in common, or the poses do "
                      "not fit them",
                      "check that poses and images have the same order and time stamps"}};
  }
  ReportFindings("match", info.findings);
  WriteMatches(files.at("output"), found, info);
  const auto length = [](const PointTrack& track) {
    return static_cast<double>(track.observations.size());
  };
  fmt::print("{}: {} points from {} pairs of {} images{}\n", sequence.name, tracks.size(),
             pairs.size(), images.size(),
             tracks.empty() ? ""
                            : fmt::format(", each in {:.0f} images (median)",
                                          *MedianOf(CollectValues(tracks, length))));
}

}  // namespace soslam
