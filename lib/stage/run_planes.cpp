// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_planes.h"

#include <fmt/format.h>

#include "artefact/planes_file.h"
#include "artefact/semantic_table_file.h"
#include "artefact/sequence_file.h"
#include "base/error.h"
#include "planes/camera_height.h"
#include "planes/estimate_planes.h"

namespace soslam {
namespace {

PlanesEstimate Estimate(const Sequence& sequence, const SemanticTable& table,
                        const PlanesOptions& options, int threads) {
  if (options.planes == PlaneSource::kCameraHeight) {
    return PlanesBelowCameras(sequence, options.camera_height_m);
  }
  return EstimatePlanes(sequence, ObjectPriors(sequence, table, RatioPrior::kTable), options,
                        threads);
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
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  const PlanesEstimate estimate = Estimate(sequence, table, options, threads);
  const ArtefactInfo info = {OptionsToJson(options), {files.at("sequence"), files.at("table")}};
  WritePlanes(files.at("report"), estimate, sequence, info);
  WriteSequence(files.at("output"), Apply(sequence, estimate, options), info);
  fmt::print("{}: {} planes of {} objects\n", sequence.name, estimate.planes.size(),
             sequence.objects.size());
}

}  // namespace soslam
