// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/files.h"
#include "artefact/model_json.h"

namespace soslam {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReconstructionSummary::Component, images, points)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReconstructionSummary, images, registered, points, observations,
                                   components, median_reprojection_error_px,
                                   median_triangulation_angle_deg)

namespace {

using nlohmann::json;

constexpr const char* kKind = "reconstruction";

}  // namespace

void WriteReconstruction(const std::filesystem::path& path, const ReconstructionSummary& summary,
                         const ArtefactInfo& info) {
  json body = summary;
  body["colmap"] = NullIfEmpty(summary.colmap);
  body["poses"] = summary.poses_are_given ? "given" : "estimated";
  body["camera"] = summary.camera_is_given ? "given" : "estimated";
  if (!summary.images_without_pose.empty()) {
    body["images_without_pose"] = summary.images_without_pose;
  }
  WriteArtefact(path, kKind, info, std::move(body));
}

ReconstructionSummary ReadReconstruction(const std::filesystem::path& path) {
  return ReadArtefactAs(path, kKind, [](const json& document) {
    auto summary = document.get<ReconstructionSummary>();
    summary.images_without_pose = document.value("images_without_pose", std::vector<std::string>());
    if (document.at("colmap").is_string()) document["colmap"].get_to(summary.colmap);
    summary.poses_are_given = document.at("poses") == "given";
    summary.camera_is_given = document.at("camera") == "given";
    return summary;
  });
}

}  // namespace soslam
