// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/text_exports.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/table.h"
#include "geometry/angles.h"

namespace soslam {
namespace {

constexpr std::array kHeader = {"id",
                                "label",
                                "segment",
                                "observations",
                                "centre_x",
                                "centre_y",
                                "centre_z",
                                "qx",
                                "qy",
                                "qz",
                                "qw",
                                "half_axis_a",
                                "half_axis_b",
                                "half_axis_c",
                                "yaw_deg",
                                "shape_exponent",
                                "sigma_centre_x",
                                "sigma_centre_y",
                                "sigma_centre_z",
                                "sigma_half_axis_a",
                                "sigma_half_axis_b",
                                "sigma_half_axis_c",
                                "sigma_yaw_deg",
                                "failure",
                                "fate",
                                "true_object",
                                "iou",
                                "reason"};
// Number of columns of the verdict, at the end.
constexpr size_t kVerdictColumns = 4;

// The values from centre to shape exponent.
std::vector<double> LandmarkValues(const WorldObject& object) {
  const Landmark& landmark = *object.estimate.landmark_in_world;
  const Eigen::Vector3d& centre = landmark.Centre();
  const Eigen::Quaterniond& rotation = landmark.frame_from_object.rotation;
  const Eigen::Vector3d& half_axes = landmark.half_axes;
  return {centre.x(),
          centre.y(),
          centre.z(),
          rotation.x(),
          rotation.y(),
          rotation.z(),
          rotation.w(),
          half_axes.x(),
          half_axes.y(),
          half_axes.z(),
          YawOf(object) * kDegPerRad,
          landmark.shape_exponent};
}

// Standard deviations of centre, half axes and yaw.
std::vector<double> Sigmas(const WorldObject& object) {
  const Covariance9& covariance = *object.estimate.covariance;
  const Eigen::Matrix<double, 9, 1> sigmas = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::Vector3d& half_axes = object.estimate.landmark_in_world->half_axes;
  const Eigen::Vector3d& up = object.support_normal;
  const double yaw_variance = up.dot(covariance.topLeftCorner<3, 3>() * up);
  return {sigmas[3],
          sigmas[4],
          sigmas[5],
          half_axes.x() * sigmas[6],
          half_axes.y() * sigmas[7],
          half_axes.z() * sigmas[8],
          std::sqrt(std::max(yaw_variance, 0.0)) * kDegPerRad};
}

std::vector<Cell> RowOf(const WorldObject& object) {
  std::vector<Cell> row = {std::to_string(object.id), object.label,
                           object.segment ? std::to_string(*object.segment) : "",
                           std::to_string(object.estimate.observations)};
  const auto add = [&](const std::vector<double>& values) {
    for (const double value : values) row.push_back(fmt::format("{}", value));
  };
  if (object.estimate.landmark_in_world) {
    add(LandmarkValues(object));
    if (object.estimate.covariance) add(Sigmas(object));
  }
  row.resize(kHeader.size() - kVerdictColumns - 1, "");
  row.push_back(object.estimate.failure);
  if (object.verdict) {
    const LandmarkVerdict& verdict = *object.verdict;
    row.push_back(verdict.fate);
    row.push_back(verdict.true_object ? std::to_string(*verdict.true_object) : "");
    row.push_back(verdict.iou ? fmt::format("{}", *verdict.iou) : "");
    row.push_back(verdict.reason);
  }
  row.resize(kHeader.size(), "");
  return row;
}

}  // namespace

std::string LandmarksCsvText(const std::vector<World>& worlds) {
  Table table;
  table.header.assign(kHeader.begin(), kHeader.end());
  for (const World& world : worlds) {
    for (const WorldObject& object : world.objects) table.rows.push_back(RowOf(object));
  }
  return ToCsv(table);
}

std::string TumTrajectoryText(const World& world) {
  std::string text = "# world_from_camera: timestamp tx ty tz qx qy qz qw\n";
  std::vector<WorldFrame> frames = world.frames;
  std::ranges::stable_sort(frames, {}, &WorldFrame::timestamp);
  for (const WorldFrame& frame : frames) {
    text += fmt::format("{} {} {}\n", frame.timestamp,
                        fmt::join(frame.world_from_camera.translation, " "),
                        fmt::join(frame.world_from_camera.rotation.coeffs(), " "));
  }
  return text;
}

}  // namespace soslam
