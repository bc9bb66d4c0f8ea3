// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_planes.h"

#include <fmt/format.h>

#include <numbers>

#include "artefact/planes_file.h"
#include "artefact/semantic_table_file.h"
#include "artefact/sequence_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/line_segments.h"
#include "planes/camera_height.h"
#include "planes/estimate_planes.h"
#include "planes/level_trajectory.h"
#include "stage/frame_images.h"

namespace soslam {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kMaxTiltOfVerticals = 12.0 * kRadians;

// Of the dataset's images, in the frames' order.
std::vector<SegmentView> ViewsOfSegments(const Sequence& sequence, const PlanesOptions& options,
                                         const StageFiles& files, int threads) {
  if (files.count("dataset") == 0) {
    throw SettingsError(
        "verticals is true; expected --dataset with the images, or verticals = false");
  }
  std::vector<SegmentView> views(sequence.frames.size());
  for (size_t i = 0; i < views.size(); ++i) {
    views[i] = {sequence.CameraOf(sequence.frames[i]), {}, sequence.frames[i].world_from_camera};
  }
  const std::vector<FrameImage> images = FrameImages(sequence, files);
  const FrameImageReader reader(sequence);
  ParallelFor(static_cast<int>(images.size()), threads, [&](int i) {
    const FrameImage& image = images[static_cast<size_t>(i)];
    SegmentView& view = views[static_cast<size_t>(image.frame - sequence.frames.data())];
    view.segments = FindLineSegments(reader.ReadGrey(image), options.vertical_min_length_px);
  });
  return views;
}

// What is known about up, and the sequence's poses with the same up in all frames.
LevelTrajectory LevelFrames(const Sequence& sequence, const PlanesOptions& options,
                            const StageFiles& files, int threads) {
  std::vector<Rigid3d> poses;
  for (const Frame& frame : sequence.frames) poses.push_back(frame.world_from_camera);
  LevelOptions level;
  level.roll_sigma = options.camera_roll_sigma_deg * kRadians;
  level.pitch_sigma = options.camera_pitch_sigma_deg * kRadians;
  level.vertical_sigma = options.vertical_sigma_deg * kRadians;
  level.odometry_sigma = options.odometry_rotation_sigma_deg * kRadians;
  level.correlation_rad = options.view_correlation_deg * kRadians;
  if (!options.verticals) {
    return {poses, AttitudeOf(poses, level.roll_sigma, level.pitch_sigma, level.correlation_rad)};
  }
  return Level(ViewsOfSegments(sequence, options, files, threads), level);
}

// Every segment has a world, and so an up and planes, of its own.
void CheckOneSegment(const Sequence& sequence, const std::filesystem::path& path) {
  const int first = sequence.frames.front().segment;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    if (sequence.frames[i].segment == first) continue;
    throw InputError(fmt::format(
        "{}: /frames/{} is of segment {}, the frames before of segment {}; expected one segment "
        "where planes are estimated, or planes = given or camera_height",
        path.string(), i, sequence.frames[i].segment, first));
  }
}

struct Result {
  PlanesEstimate estimate;
  Sequence sequence;
};

Result FromBoxes(const Sequence& sequence, const PlanesOptions& options, const StageFiles& files,
                 int threads) {
  CheckOneSegment(sequence, files.at("sequence"));
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  const LevelTrajectory trajectory = LevelFrames(sequence, options, files, threads);
  Sequence level = sequence;
  for (size_t i = 0; i < level.frames.size(); ++i) {
    level.frames[i].world_from_camera = trajectory.world_from_camera[i];
  }
  Result result;
  result.estimate = EstimatePlanes(level, ObjectPriors(sequence, table, RatioPrior::kTable),
                                   trajectory.attitude, options, threads);
  result.sequence = WithPlanes(std::move(level), result.estimate);
  result.sequence.frames = sequence.frames;  // odometry stays what was measured
  return result;
}

// In every frame it is the ground, whatever the trajectory says.
Result FromCameraHeight(const Sequence& sequence, const PlanesOptions& options) {
  Result result;
  result.estimate = PlanesBelowCameras(sequence, options.camera_height_m);
  result.sequence = WithPlanes(sequence, result.estimate);
  for (Detection& detection : result.sequence.detections) {
    detection.plane_in_camera = GroundInCamera(options.camera_height_m);
  }
  return result;
}

}  // namespace

void RunPlanes(const PlanesOptions& options, const StageFiles& files, int threads) {
  if (options.planes == PlaneSource::kGiven) {
    throw SettingsError(
        "planes is given; expected estimated or camera_height (given planes need no stage)");
  }
  const Sequence sequence = ReadSequence(files.at("sequence"), PlaneNeed::kNotNeeded);
  const Result result = options.planes == PlaneSource::kCameraHeight
                            ? FromCameraHeight(sequence, options)
                            : FromBoxes(sequence, options, files, threads);
  const ArtefactInfo info = {OptionsToJson(options), {files.at("sequence"), files.at("table")}};
  WritePlanes(files.at("report"), result.estimate, sequence, info);
  WriteSequence(files.at("output"), result.sequence, info);
  fmt::print("{}: {} planes of {} objects\n", sequence.name, result.estimate.planes.size(),
             sequence.objects.size());
}

}  // namespace soslam
