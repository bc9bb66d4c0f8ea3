// SPDX-License-Identifier: BSD-3-Clause
#include "ground/ground_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"

namespace soslam {
namespace {

constexpr const char* kGiveScale =
    "give scale or camera_height_m; lengths are only as good as the scale";

std::string InPercent(const ScalePosterior& scale) {
  return fmt::format("{:.0f} %", 100.0 * std::expm1(0.5 * (scale.high - scale.low)));
}

void CheckScale(const GroundEstimate& estimate, std::vector<Finding>* findings) {
  constexpr double kUncertain = 0.25;  // of the logarithm
  if (!estimate.scale) {
    findings->push_back({"scale_unknown", Severity::kError,
                         fmt::format("none of {} objects has a label with a height and a body that "
                                     "fits its boxes; lengths have the unit of the input",
                                     estimate.objects.size()),
                         "objects with heights in the semantic table, scale or camera_height_m",
                         "too few boxes, or labels that the table does not have", kGiveScale});
    return;
  }
  if (estimate.scale->log_sigma < kUncertain) return;
  findings->push_back(
      {"scale_uncertain", Severity::kWarning,
       fmt::format("the scale is known to +- {} (95 %), from {:.1f} independent objects",
                   InPercent(*estimate.scale), estimate.independent_objects),
       fmt::format("a standard deviation below {:.0f} %", 100.0 * kUncertain),
       "too few objects whose labels have heights, or heights that vary much", kGiveScale});
}

void CheckContradictions(const GroundEstimate& estimate, std::vector<Finding>* findings) {
  constexpr double kOtherScales = 0.05;  // probability
  constexpr double kMisfit = 2.0;        // variance of heights, relative to that of the table
  constexpr double kAgreement = 0.5;     // share of the objects
  if (!estimate.scale_of_objects) return;
  const ScalePosterior& scale = *estimate.scale_of_objects;
  const auto agreeing =
      std::ranges::count_if(scale.agreement, [](double probability) { return probability >= 0.5; });
  const auto objects = static_cast<double>(scale.agreement.size());
  if (scale.second_mode_share < kOtherScales && scale.misfit < kMisfit &&
      static_cast<double>(agreeing) >= kAgreement * objects) {
    return;
  }
  findings->push_back(
      {"scale_contradicted", Severity::kWarning,
       fmt::format("{} of {} objects agree on a scale; their heights vary {:.1f} times as much as "
                   "those of their labels; another scale has a probability of {:.0f} %",
                   agreeing, scale.agreement.size(), std::sqrt(scale.misfit),
                   100.0 * scale.second_mode_share),
       "most objects have heights of their labels at one scale",
       "wrong labels, poses that drift, or objects of unusual size (a toy car)", kGiveScale});
}

// Known values against the heights of objects.
void CheckKnownScale(const GroundEstimate& estimate, std::vector<Finding>* findings) {
  constexpr double kLimit = 3.0;  // standard deviations
  if (!estimate.scale || !estimate.scale_of_objects) return;
  const double difference = estimate.scale->log_scale - estimate.scale_of_objects->log_scale;
  if (std::abs(difference) < kLimit * estimate.scale_of_objects->log_sigma) return;
  findings->push_back(
      {"scale_of_objects_differs", Severity::kWarning,
       fmt::format("objects are {:.2f} times as high as their labels at the scale that scale and "
                   "camera_height_m give",
                   std::exp(difference)),
       fmt::format("a factor within {} standard deviations of the objects' {:.0f} %", kLimit,
                   100.0 * estimate.scale_of_objects->log_sigma),
       "scale or camera_height_m in another unit, a floor that is not seen, so that the lowest "
       "plane "
       "is a table top, or wrong labels",
       "check scale and camera_height_m, or leave them away"});
}

// A wrong up direction has few objects on its planes.
void CheckSupport(const GroundEstimate& estimate, std::vector<Finding>* findings) {
  constexpr size_t kFewest = 5;
  constexpr double kFew = 0.25;
  const auto on_planes = std::ranges::count_if(
      estimate.objects, [](const GroundObject& object) { return object.plane != kNoPlane; });
  if (estimate.objects.size() < kFewest || estimate.planes.empty() ||
      static_cast<double>(on_planes) >= kFew * static_cast<double>(estimate.objects.size())) {
    return;
  }
  findings->push_back({"few_objects_on_planes", Severity::kWarning,
                       fmt::format("{} of {} objects stand on the support planes that were found",
                                   on_planes, estimate.objects.size()),
                       fmt::format("at least {:.0f} %", 100.0 * kFew),
                       "a wrong up direction, as of cameras that were turned in many ways, or "
                       "surfaces without texture",
                       "look at the map from the side; more images of the ground"});
}

void CheckHolding(const GroundEstimate& estimate, std::vector<Finding>* findings) {
  const CameraHolding holding = estimate.attitude.holding;
  if (holding == estimate.holding_of_boxes) return;
  findings->push_back(
      {"camera_holding_of_planes", Severity::kWarning,
       fmt::format("by their boxes cameras are held {}; up is that of cameras held {}, as then at "
                   "least twice as many objects stand on planes, of twice as many points",
                   NameOf(estimate.holding_of_boxes), NameOf(holding)),
       "one way to hold cameras that explains boxes and planes",
       "cameras that were turned in many ways, or look down",
       "look at the map from the side; images with the camera held level"});
}

void CheckCameraHeight(const GroundEstimate& estimate, const GroundOptions& options,
                       std::vector<Finding>* findings) {
  constexpr const char* kName = "camera_height_m";
  if (options.camera_height_m <= 0.0 ||
      std::ranges::find(estimate.scale_found_by, kName) != estimate.scale_found_by.end()) {
    return;
  }
  findings->push_back(
      {"camera_height_unused", Severity::kWarning,
       "camera_height_m is given, and no horizontal plane below the cameras is found",
       "a plane that camera_height_m is the height above", "a floor without texture has no points",
       "give scale instead"});
}

}  // namespace

std::vector<Finding> CheckGround(const GroundEstimate& estimate, const GroundOptions& options) {
  constexpr double kUncertainUpDeg = 2.0;
  std::vector<Finding> findings;
  CheckScale(estimate, &findings);
  CheckContradictions(estimate, &findings);
  CheckKnownScale(estimate, &findings);
  CheckCameraHeight(estimate, options, &findings);
  CheckHolding(estimate, &findings);
  CheckSupport(estimate, &findings);
  if (estimate.planes.empty()) {
    findings.push_back({"no_support_plane", Severity::kWarning,
                        fmt::format("no object stands on any of {} horizontal planes in {} points",
                                    estimate.planes_of_points, estimate.points),
                        "a floor or a table top with objects on it",
                        "surfaces without texture have no points",
                        "let soslam-planes estimate the planes from boxes"});
  }
  if (kDegPerRad * estimate.tilt_sigma > kUncertainUpDeg) {
    findings.push_back({"up_uncertain", Severity::kWarning,
                        fmt::format("the standard deviation of up is {:.1f} degrees",
                                    kDegPerRad * estimate.tilt_sigma),
                        fmt::format("at most {:.0f} degrees", kUncertainUpDeg),
                        "few points on horizontal planes, or planes that are not parallel",
                        "look at the map from the side; more images from other directions"});
  }
  return findings;
}

}  // namespace soslam
