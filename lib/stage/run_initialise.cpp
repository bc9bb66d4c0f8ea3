// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_initialise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>

#include "artefact/landmarks_file.h"
#include "artefact/semantic_table_file.h"
#include "artefact/sequence_file.h"
#include "base/error.h"
#include "cli/report_findings.h"
#include "evaluation/result_checks.h"
#include "geometry/angles.h"
#include "initialisation/initialise.h"

namespace soslam {
namespace {

std::map<std::string, int> CountFailures(const LandmarkEstimates& estimates) {
  std::map<std::string, int> failures;
  for (const auto& observation : estimates.observations) {
    if (observation.hypotheses.empty()) ++failures[observation.failure];
  }
  for (const auto& object : estimates.objects) {
    if (!object.landmark_in_world) ++failures[object.failure];
  }
  return failures;
}

std::vector<std::optional<YawPrior>> YawPriorsOf(
    const Sequence& sequence, const std::vector<std::optional<ShapePrior>>& shapes,
    const InitialiseOptions& options, int threads) {
  const StandingOptions standing = {options.upright.detection_sigma_fraction,
                                    options.view_correlation_deg * kRadPerDeg,
                                    options.upright.yaw_grid_deg * kRadPerDeg};
  return YawPriors(sequence, shapes, options.yaw_prior, standing, threads);
}

}  // namespace

void RunInitialise(const InitialiseOptions& options, const StageFiles& files, int threads) {
  const Sequence sequence = ReadSequence(files.at("sequence"));
  const SemanticTable table = ReadSemanticTable(files.at("table"));
  LandmarkEstimates estimates;
  if (options.method == InitialisationMethod::kSvd) {
    estimates = InitialiseSvd(sequence);
  } else {
    if (options.ratio_prior == RatioPrior::kTable) {
      const auto labels = LabelsWithoutEntry(sequence, table);
      if (!labels.empty()) {
        fmt::print(stderr, "soslam-initialise: not in {}: {}; {}\n", files.at("table").string(),
                   fmt::join(labels, ", "),
                   table.default_prior ? "its default is used" : "their objects are left out");
      }
    }
    const auto priors = ObjectPriors(sequence, table, options.ratio_prior, options.shape);
    if (options.method == InitialisationMethod::kMultiView) {
      estimates = InitialiseMultiView(sequence, priors, options, threads);
    } else if (options.method == InitialisationMethod::kYawSweep) {
      estimates = InitialiseUpright(sequence, priors, options.upright, threads,
                                    YawPriorsOf(sequence, priors, options, threads));
    } else {
      estimates = InitialiseSingleFrame(
          sequence, ObjectRatios(sequence, table, options.ratio_prior), options, threads);
    }
  }

  const auto failures = CountFailures(estimates);
  int failed = 0;
  std::string reasons;
  for (const auto& [reason, count] : failures) {
    failed += count;
    reasons += fmt::format(" {} {}", reason, count);
  }
  const auto tried = static_cast<int>(estimates.observations.size() + estimates.objects.size());
  if (failed == tried) {
    throw NothingUsableError(fmt::format("{}: no landmark from {} tries:{}",
                                         files.at("sequence").string(), tried, reasons));
  }
  std::vector<Finding> findings = CheckFailures(estimates);
  std::ranges::move(options.method == InitialisationMethod::kSvd
                        ? CheckDegenerate(estimates)
                        : CheckSizes(estimates, sequence, table),
                    std::back_inserter(findings));
  std::ranges::move(CheckCollapsed(estimates), std::back_inserter(findings));
  ReportFindings("initialise", findings);
  WriteLandmarks(files.at("output"), estimates, sequence,
                 {OptionsToJson(options), {files.at("sequence"), files.at("table")}, findings});
  fmt::print("{} landmarks{}{}\n", tried - failed, failed > 0 ? ", without one:" : "", reasons);
}

}  // namespace soslam
