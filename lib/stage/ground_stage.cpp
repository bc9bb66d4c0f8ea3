// SPDX-License-Identifier: BSD-3-Clause
#include "stage/ground_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "artefact/points_file.h"
#include "artefact/semantic_table_file.h"
#include "artefact/sequence_file.h"
#include "artefact/world_file.h"
#include "base/error.h"
#include "base/text.h"
#include "cli/command_line.h"
#include "evaluation/result_checks.h"
#include "geometry/angles.h"
#include "ground/estimate_ground.h"
#include "ground/ground_checks.h"
#include "ground/world_scale.h"
#include "planes/scene_axis.h"
#include "stage/segment_views.h"

namespace soslam {
namespace {

std::string ScaleInWords(const std::optional<WorldScale>& scale) {
  if (!scale) return "unknown scale";
  const std::string contradictions = ContradictionsInWords(*scale);
  return fmt::format("scale +- {:.0f} % (95 %) from {}{}{}", HalfIntervalPercent(*scale),
                     SourcesInWords(*scale),
                     contradictions.empty() ? "" : ", uncertain: ", contradictions);
}

void PrintGroundSummary(const Sequence& sequence, const GroundEstimate& estimate,
                        const std::optional<WorldScale>& scale) {
  fmt::print("{}: up +- {:.1f} degrees (one standard deviation), {}, {}\n", sequence.name,
             kDegPerRad * estimate.tilt_sigma, ScaleInWords(scale),
             Counted(estimate.planes.size(), "support plane"));
}

}  // namespace

void RunGround(const GroundOptions& options, const StageFiles& files, int threads) {
  if (options.ground == GroundSource::kGiven) {
    throw SettingsError("ground is given; expected estimated (a given world needs no stage)");
  }
  const Sequence sequence = ReadSequence(files.at("sequence"), PlaneNeed::kNotNeeded);
  if (sequence.frames.empty()) {
    throw NothingUsableError(files.at("sequence").string() + ": has no frames; expected some");
  }
  CheckOneSegment(sequence, files.at("sequence"));
  ArtefactInfo info = {OptionsToJson(options),
                       {files.at("sequence"), files.at("points"), files.at("table")}};
  std::vector<SegmentView> views;
  if (options.verticals) {
    views = ViewsOfSegments(sequence, options.vertical_min_length_px, files, threads, &info.inputs);
  }
  const GroundEstimate estimate =
      EstimateGround(sequence, ReadPoints(files.at("points")), views,
                     ReadSemanticTable(files.at("table")), options, threads);
  info.findings = CheckGround(estimate, options);
  if (estimate.IsUpByBoxes()) {
    std::ranges::move(CheckUp(estimate.attitude.holding, estimate.attitude.holdings,
                              estimate.attitude.holding_tilt_variance),
                      std::back_inserter(info.findings));
  }
  ReportFindings("ground", info.findings);
  WriteWorld(files.at("world"), estimate, sequence, info);
  Sequence grounded = WithGround(sequence, estimate);
  for (size_t i = 0; i < views.size(); ++i) {
    views[i].world_from_camera = grounded.frames[i].world_from_camera;
  }
  SetSceneAxes(views, options.view_correlation_deg * kRadPerDeg, &grounded);
  WriteSequence(files.at("output"), grounded, info);
  PrintGroundSummary(sequence, estimate, WorldScaleOf(estimate, info.findings));
}

}  // namespace soslam
