// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/files.h"

namespace soslam {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReconstructionSummary::Component, images, points)

namespace {

using nlohmann::json;

constexpr const char* kKind = "reconstruction";

}  // namespace

void WriteReconstruction(const std::filesystem::path& path, const ReconstructionSummary& summary,
                         const ArtefactInfo& info) {
  json body = {{"images", summary.images},
               {"registered", summary.registered},
               {"points", summary.points},
               {"observations", summary.observations},
               {"components", summary.components},
               {"median_reprojection_error_px", summary.median_reprojection_error_px},
               {"median_triangulation_angle_deg", summary.median_triangulation_angle_deg},
               {"colmap", summary.colmap.empty() ? json() : json(summary.colmap)},
               {"poses", summary.poses_are_given ? "given" : "estimated"},
               {"camera", summary.camera_is_given ? "given" : "estimated"}};
  if (!summary.images_without_pose.empty()) {
    body["images_without_pose"] = summary.images_without_pose;
  }
  WriteArtefact(path, kKind, info, std::move(body));
}

ReconstructionSummary ReadReconstruction(const std::filesystem::path& path) {
  return ReadArtefactAs(path, kKind, [](const json& document) {
    ReconstructionSummary summary;
    document.at("images").get_to(summary.images);
    document.at("registered").get_to(summary.registered);
    summary.images_without_pose = document.value("images_without_pose", std::vector<std::string>());
    document.at("points").get_to(summary.points);
    document.at("observations").get_to(summary.observations);
    document.at("components").get_to(summary.components);
    document.at("median_reprojection_error_px").get_to(summary.median_reprojection_error_px);
    document.at("median_triangulation_angle_deg").get_to(summary.median_triangulation_angle_deg);
    if (document.at("colmap").is_string()) document["colmap"].get_to(summary.colmap);
    summary.poses_are_given = document.at("poses") == "given";
    summary.camera_is_given = document.at("camera") == "given";
    return summary;
  });
}

}  // namespace soslam
