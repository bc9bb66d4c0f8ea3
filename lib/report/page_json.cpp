// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_json.h"

#include <fmt/format.h>

#include <cmath>

#include "inspection/projection.h"

namespace soslam {
namespace {

using nlohmann::json;

json Rounded(double value, double per_unit) {
  return std::isfinite(value) ? json(std::round(value * per_unit) / per_unit) : json();
}

json Millimetres(double metres) { return Rounded(metres, 1e4); }
json Tenths(double pixels) { return Rounded(pixels, 10.0); }

}  // namespace

json PageNumber(double value) {
  return std::isfinite(value) ? json(std::stod(fmt::format("{:.5g}", value))) : json();
}

json PageNumbers(const std::vector<double>& values) {
  json numbers = json::array();
  for (const double value : values) numbers.push_back(PageNumber(value));
  return numbers;
}

json PageVector(const Eigen::Vector3d& metres) {
  return {Millimetres(metres.x()), Millimetres(metres.y()), Millimetres(metres.z())};
}

json PagePose(const Rigid3d& pose) {
  json numbers = PageVector(pose.translation);
  for (const double part : pose.rotation.coeffs()) numbers.push_back(PageNumber(part));
  return numbers;
}

json PageLandmark(const Landmark& landmark_in_world) {
  return {{"pose", PagePose(landmark_in_world.frame_from_object)},
          {"half_axes", PageVector(landmark_in_world.half_axes)},
          {"p", PageNumber(landmark_in_world.shape_exponent)}};
}

json PagePixels(const std::vector<Eigen::Vector2d>& pixels) {
  json numbers = json::array();
  for (const Eigen::Vector2d& pixel : pixels) {
    numbers.push_back(Tenths(pixel.x()));
    numbers.push_back(Tenths(pixel.y()));
  }
  return numbers;
}

json PageOutline(const Camera& camera, const Landmark& landmark_in_camera) {
  json axes;
  if (const auto projected = ProjectedAxes(camera, landmark_in_camera)) {
    for (const LineSegment2& axis : *projected) axes.push_back(PagePixels({axis[0], axis[1]}));
  }
  return {{"outline", PagePixels(OutlinePolygon(camera, landmark_in_camera))}, {"axes", axes}};
}

}  // namespace soslam
