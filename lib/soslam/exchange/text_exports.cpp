// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "soslam/base/table.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/exchange/exports.h"
#include "soslam/geometry/angles.h"

namespace soslam {
namespace {

constexpr const char* kHeader =
    "id,label,segment,observations,centre_x,centre_y,centre_z,qx,qy,qz,qw,half_axis_a,half_axis_b,"
    "half_axis_c,yaw_deg,shape_exponent,vertical_exponent,sigma_centre_x,sigma_centre_y,sigma_"
    "centre_z,sigma_half_axis_a,sigma_half_axis_b,sigma_half_axis_c,sigma_yaw_deg,failure,fate,"
    "true_object,iou,reason,front_probability";
constexpr size_t kFailureColumn = 24;
constexpr size_t kFrontColumn = kFailureColumn + 5;

template <typename Numbers>
void Append(const Numbers& numbers, std::vector<std::string>* row) {
  for (const double number : numbers) row->push_back(fmt::format("{}", number));
}

std::vector<std::string> MakeCsvRow(const WorldObject& object) {
  std::vector<std::string> row = {std::to_string(object.id), CsvText(object.label),
                                  object.segment ? std::to_string(*object.segment) : "",
                                  std::to_string(object.estimate.observations)};
  if (object.estimate.landmark_in_world) {
    const Landmark& landmark = *object.estimate.landmark_in_world;
    Append(landmark.Centre(), &row);
    Append(landmark.frame_from_object.rotation.coeffs(), &row);
    Append(landmark.half_axes, &row);
    Append(std::array{ComputeYaw(object) * kDegPerRad, landmark.shape_exponents.horizontal,
                      landmark.shape_exponents.vertical},
           &row);
    if (object.estimate.covariance) {
      const Covariance9& covariance = *object.estimate.covariance;
      const Eigen::Matrix<double, 9, 1> sigmas = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
      const Eigen::Vector3d& up = object.support_normal;
      const double yaw_variance = up.dot(covariance.topLeftCorner<3, 3>() * up);
      Append(sigmas.segment<3>(3), &row);
      Append(Eigen::Vector3d(landmark.half_axes.cwiseProduct(sigmas.tail<3>())), &row);
      Append(std::array{std::sqrt(std::max(yaw_variance, 0.0)) * kDegPerRad}, &row);
    }
  }
  row.resize(kFailureColumn);
  row.push_back(CsvText(object.estimate.failure));
  if (object.verdict) {
    const LandmarkVerdict& verdict = *object.verdict;
    row.push_back(CsvText(verdict.fate));
    row.push_back(verdict.true_object ? std::to_string(*verdict.true_object) : "");
    row.push_back(verdict.iou ? fmt::format("{}", *verdict.iou) : "");
    row.push_back(CsvText(verdict.reason));
  }
  row.resize(kFrontColumn);
  const auto& front_probability = object.estimate.front_probability;
  row.push_back(front_probability ? fmt::format("{}", *front_probability) : "");
  return row;
}

}  // namespace

std::string LandmarksCsvText(const std::vector<World>& worlds) {
  std::string text = fmt::format("{}\n", kHeader);
  for (const World& world : worlds) {
    for (const WorldObject& object : world.objects) {
      text += fmt::format("{}\n", fmt::join(MakeCsvRow(object), ","));
    }
  }
  return text;
}

std::string BoxesCsvText(const World& world) {
  const Eigen::Vector3d up = EstimateCommonUp(world);
  std::string text = "label,x,y,z,size_x,size_y,size_z,yaw_deg,score,id\n";
  for (const WorldObject& object : world.objects) {
    if (!object.estimate.landmark_in_world) continue;
    const Landmark& landmark = *object.estimate.landmark_in_world;
    const Eigen::Quaterniond& rotation = landmark.frame_from_object.rotation;
    int z = 2;
    (rotation.conjugate() * up).cwiseAbs().maxCoeff(&z);
    const int x = z == 0 ? 1 : 0, y = 3 - x - z;
    const Eigen::Quaterniond quarter_turn(
        Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()));
    const double yaw = Yaw(up, x == 0 ? rotation : rotation * quarter_turn);
    const Eigen::Vector3d& half = landmark.half_axes;
    text += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.4g},{}\n", CsvText(object.label),
                        fmt::join(landmark.Centre(), ","),
                        fmt::join(std::array{2.0 * half[x], 2.0 * half[y], 2.0 * half[z]}, ","),
                        yaw * kDegPerRad, object.score, object.id);
  }
  return text;
}

std::string TumTrajectoryText(const World& world) {
  std::string text = "# world_from_camera: timestamp tx ty tz qx qy qz qw\n";
  std::vector<WorldFrame> frames = world.frames;
  std::ranges::stable_sort(frames, {}, &WorldFrame::timestamp);
  for (const WorldFrame& frame : frames) {
    text += TrajectoryLine({frame.timestamp, frame.world_from_camera});
  }
  return text;
}

}  // namespace soslam
