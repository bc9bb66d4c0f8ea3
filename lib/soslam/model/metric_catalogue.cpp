// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/metric_catalogue.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "soslam/geometry/angles.h"

namespace soslam {

std::string Metric::Key() const { return *unit == '\0' ? name : fmt::format("{}_{}", name, unit); }

std::string Metric::Header() const {
  return *unit == '\0' ? title : fmt::format("{} {}", title, unit);
}

bool Metric::IsBetter(double value, double other) const {
  return more_is_better ? value > other : value < other;
}

std::string Metric::Text(const std::optional<double>& value, const char* none) const {
  return value ? fmt::format("{:.{}f}", *value, decimals) : none;
}

std::string Metric::Text(const MetricValues& values, const char* none) const {
  std::string text;
  for (const auto& value : values) text += (text.empty() ? "" : ", ") + Text(value, none);
  return text;
}

std::optional<double> YawSigmaDeg(const ObjectEstimate& estimate) {
  if (!estimate.covariance || !estimate.landmark_in_world) return std::nullopt;
  const Eigen::Vector3d up =
      estimate.landmark_in_world->frame_from_object.rotation * Eigen::Vector3d::UnitZ();
  return kDegPerRad * std::sqrt(up.dot(estimate.covariance->topLeftCorner<3, 3>() * up));
}

}  // namespace soslam
