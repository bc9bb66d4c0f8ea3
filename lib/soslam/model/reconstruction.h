// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "soslam/base/description.h"

namespace soslam {

enum class DataSource { kEstimated, kGiven };
inline constexpr std::array kDataSourceNames = {"estimated", "given"};
inline constexpr const auto& NamesOf(DataSource) { return kDataSourceNames; }

// Summary of a reconstruction by structure from motion, for reconstruction.json.
struct ReconstructionSummary {
  // A model with its own world, not connected to the others.
  struct Component {
    int images = 0;
    int points = 0;
    std::string folder =
        {};  // its name, beside those of the others; empty for a model without others
  };
  int images = 0;      // in the dataset's list
  int registered = 0;  // images with a pose
  std::vector<std::string> images_without_pose = {};
  int points = 0;
  int observations = 0;
  std::vector<Component> components;                     // largest first; the first one is used
  std::optional<double> median_reprojection_error_px;    // over points whose error is known
  std::optional<double> median_triangulation_angle_deg;  // over points, the widest of each
  std::string colmap;  // version that ran; empty: the model was given
  DataSource poses = DataSource::kEstimated;
  DataSource camera = DataSource::kEstimated;
};

template <typename Visitor>
void Describe(Visitor& visit, ReconstructionSummary::Component& component) {
  visit.Field("images", &component.images, "with a pose", kNotNegative);
  visit.Field("points", &component.points, "number", kNotNegative);
  visit.OrAbsent("folder", &component.folder,
                 "name of the model's folder, beside those of the others; absent without others");
}

template <typename Visitor>
void Describe(Visitor& visit, ReconstructionSummary& summary) {
  visit.Field("images", &summary.images, "in rgb.txt", kNotNegative);
  visit.Field("registered", &summary.registered, "images that have a pose", kNotNegative);
  visit.OrAbsent("images_without_pose", &summary.images_without_pose,
                 "the other ones, as rgb.txt names them; absent also in older files");
  visit.Field("points", &summary.points, "in points.h5", kNotNegative);
  visit.Field("observations", &summary.observations, "image points of these", kNotNegative);
  visit.Field("components", &summary.components,
              "models without connection, each with a world of its own, largest first; the first "
              "one is used",
              {.min = 0, .least_items = 1});
  visit.Field("median_reprojection_error_px", &summary.median_reprojection_error_px,
              "over the points; null where none is known", kNotNegative);
  visit.Field("median_triangulation_angle_deg", &summary.median_triangulation_angle_deg,
              "over the points, of the largest angle between two rays", {0.0, 180.0});
  visit.OrNull("colmap", &summary.colmap, "version that ran; null where a model was given");
  visit.Field("poses", &summary.poses,
              "given: those of odometry.txt; estimated: in an arbitrary world and unit");
  visit.Field("camera", &summary.camera, "given: that of camera.json; estimated: calibrated");
}

}  // namespace soslam
