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
#include "image/read_image.h"
#include "planes/camera_height.h"
#include "planes/estimate_planes.h"
#include "planes/verticals.h"
#include "stage/image_paths.h"

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
  const auto images = ImagePaths(sequence, files.at("dataset"), files.at("sequence"));
  std::vector<SegmentView> views(images.size());
  ParallelFor(static_cast<int>(images.size()), threads, [&](int i) {
    const auto index = static_cast<size_t>(i);
    const cv::Mat grey =
        ReadGreyImage(images[index], sequence.camera.width, sequence.camera.height);
    views[index] = {FindLineSegments(grey, options.vertical_min_length_px),
                    sequence.frames[index].world_from_camera};
  });
  return views;
}

CameraAttitude Attitude(const Sequence& sequence, const PlanesOptions& options,
                        const StageFiles& files, int threads) {
  std::vector<Rigid3d> poses;
  for (const Frame& frame : sequence.frames) poses.push_back(frame.world_from_camera);
  const double correlation = options.view_correlation_deg * kRadians;
  const CameraAttitude attitude =
      AttitudeOf(poses, options.camera_roll_sigma_deg * kRadians,
                 options.camera_pitch_sigma_deg * kRadians, correlation);
  if (!options.verticals) return attitude;
  return WithVerticals(attitude, sequence.camera,
                       ViewsOfSegments(sequence, options, files, threads),
                       options.vertical_sigma_deg * kRadians, correlation, kMaxTiltOfVerticals);
}

PlanesEstimate Estimate(const Sequence& sequence, const PlanesOptions& options,
                        const StageFiles& files, int threads) {
  if (options.planes == PlaneSource::kCameraHeight) {
    return PlanesBelowCameras(sequence, options.camera_height_m);
  }
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  return EstimatePlanes(sequence, ObjectPriors(sequence, table, RatioPrior::kTable),
                        Attitude(sequence, options, files, threads), options, threads);
}

// With the camera's height it is the ground in every frame, whatever the trajectory says.
Sequence Apply(const Sequence& sequence, const PlanesEstimate& estimate,
               const PlanesOptions& options) {
  Sequence with_planes = WithPlanes(sequence, estimate);
  if (options.planes != PlaneSource::kCameraHeight) return with_planes;
  for (Detection& detection : with_planes.detections) {
    detection.plane_in_camera = GroundInCamera(options.camera_height_m);
  }
  return with_planes;
}

}  // namespace

void RunPlanes(const PlanesOptions& options, const StageFiles& files, int threads) {
  if (options.planes == PlaneSource::kGiven) {
    throw SettingsError(
        "planes is given; expected estimated or camera_height (given planes need no stage)");
  }
  const Sequence sequence = ReadSequence(files.at("sequence"));
  const PlanesEstimate estimate = Estimate(sequence, options, files, threads);
  const ArtefactInfo info = {OptionsToJson(options), {files.at("sequence"), files.at("table")}};
  WritePlanes(files.at("report"), estimate, sequence, info);
  WriteSequence(files.at("output"), Apply(sequence, estimate, options), info);
  fmt::print("{}: {} planes of {} objects\n", sequence.name, estimate.planes.size(),
             sequence.objects.size());
}

}  // namespace soslam
