// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <map>
#include <set>
#include <string>

#include "dataset/dataset_checks.h"
#include "dataset/gate.h"

namespace soslam {
namespace {

struct CauseAndRemedy {
  const char* cause;
  const char* remedy;
};

// Gates that reject detections because of the data; the others apply what a setting asks for.
const std::map<std::string, CauseAndRemedy>& GatesOfData() {
  const auto name = [](RejectReason reason) { return std::string(RejectReasonName(reason)); };
  static const std::map<std::string, CauseAndRemedy> gates = {
      {name(RejectReason::kFrameWithoutPose),
       {"a trajectory of other images, or of another clock",
        "compare the time stamps of images and trajectory; max_time_difference_s"}},
      {name(RejectReason::kBeyondLensModel),
       {"distortion of another camera, or with coefficients in another order",
        "give k1, k2, p1, p2, k3 as OpenCV has them"}},
      {name(RejectReason::kEmptyBox),
       {"boxes of another convention, as x, y, width, height", "give corners x1, y1, x2, y2"}},
      {name(RejectReason::kOutsideImage),
       {"boxes of images of another size", "give boxes in pixels of the camera's image"}},
      {name(RejectReason::kNearBorder),
       {"objects that the image cuts, which the paper's protocol drops",
        "a smaller border_px keeps them, with the cut edges as bounds"}},
      {name(RejectReason::kDuplicate),
       {"several boxes of one object in one image, or one id for several objects",
        "an id for each object, or no ids and estimated association"}},
      {name(RejectReason::kTooFewObservations),
       {"ids that change from image to image",
        "ids that stay, or no ids and estimated association; min_observations"}},
      {name(RejectReason::kWithoutObjectId),
       {"a tracker that finds few tracks", "no object_id and estimated association"}}};
  return gates;
}

// Number of detections that reach the gates of data.
int Asked(const Sequence& sequence, size_t used) {
  int count = static_cast<int>(used);
  for (const auto& [reason, number] : sequence.rejected_detections) {
    if (GatesOfData().contains(reason)) count += number;
  }
  return count;
}

}  // namespace

std::vector<Finding> CheckRejections(const ImportView& view) {
  if (view.options.format == DatasetFormat::kKittiObject)
    return {};  // each image has its own world
  constexpr int kFewest = 10;
  const int all = Asked(view.sequence, view.sequence.detections.size());
  std::vector<Finding> findings;
  for (const auto& [reason, count] : view.sequence.rejected_detections) {
    const auto gate = GatesOfData().find(reason);
    if (gate == GatesOfData().end() || all < kFewest || 3 * count <= all) continue;
    findings.push_back({"rejected_" + reason, Severity::kWarning,
                        fmt::format("{} of {} detections are dropped as {}", count, all, reason),
                        "at most a third dropped for one reason", gate->second.cause,
                        gate->second.remedy});
  }
  return findings;
}

}  // namespace soslam
