// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dataset/dataset_checks.h"

namespace soslam {
namespace {

// True within the tolerance for rounding and crops of tools.
bool IsAbout(double value, double expected, double relative = 0.05) {
  return std::abs(value - expected) <= relative * std::abs(expected);
}

std::string InWords(const Camera& camera) {
  return fmt::format("camera of {} x {} pixels with fx {:g}, fy {:g}, cx {:g}, cy {:g}",
                     camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy);
}

// True if the principal point would be the image centre with width and height swapped.
bool HasSwappedSides(const Camera& camera) {
  const bool is_off =
      !IsAbout(camera.cx, 0.5 * camera.width, 0.1) || !IsAbout(camera.cy, 0.5 * camera.height, 0.1);
  return is_off && IsAbout(camera.cx, 0.5 * camera.height) &&
         IsAbout(camera.cy, 0.5 * camera.width);
}

// Scale of the image whose centre is the principal point; 0 for none.
double ScaleOfPrincipalPoint(const Camera& camera) {
  const double by_x = 2.0 * camera.cx / camera.width;
  const double by_y = 2.0 * camera.cy / camera.height;
  return by_x > 0.0 && IsAbout(by_y, by_x) ? by_x : 0.0;
}

void ExplainIntrinsics(const Camera& camera, Finding* finding) {
  const double scale = ScaleOfPrincipalPoint(camera);
  if (camera.cx <= 2.0 && camera.cy <= 2.0) {
    finding->cause = "intrinsics as fractions of the image";
    finding->remedy =
        fmt::format("multiply fx, cx by {} and fy, cy by {}", camera.width, camera.height);
  } else if (HasSwappedSides(camera)) {
    finding->cause = "width and height swapped, as of a camera held upright";
    finding->remedy = fmt::format("width {}, height {}", camera.height, camera.width);
  } else if (scale > 1.2 || (scale > 0.0 && scale < 0.8)) {
    finding->cause = fmt::format("intrinsics of images {:.3g} times as large", scale);
    finding->remedy = fmt::format("divide fx, fy, cx, cy by {:.4g}", scale);
  } else if (camera.fx < 0.2 * camera.width) {
    finding->cause = "a focal length in millimetres";
    finding->remedy =
        "give fx, fy in pixels: millimetres times the width of the image in pixels, "
        "divided by that of the sensor in millimetres";
  } else {
    finding->cause = "intrinsics of another camera";
    finding->remedy = "give those of the camera that took the images, in pixels";
  }
}

std::vector<Finding> CheckIntrinsics(const Camera& camera) {
  const auto is_focal_length = [&](double focal_length) {
    return focal_length >= 0.2 * camera.width && focal_length <= 10.0 * camera.width;
  };
  const double x = (camera.cx + 0.5) / camera.width;
  const double y = (camera.cy + 0.5) / camera.height;
  const bool is_inside = x > 0.0 && x < 1.0 && y > 0.0 && y < 1.0;
  const bool is_central = std::min({x, y, 1.0 - x, 1.0 - y}) > 0.25;
  const double scale = std::max(camera.width, camera.height);
  const bool is_focal =
      is_focal_length(camera.fx) && camera.fy >= 0.2 * camera.height && camera.fy <= 10.0 * scale;
  if (is_focal && is_inside && is_central && !HasSwappedSides(camera)) return {};
  const bool is_impossible = !is_focal || !is_inside || HasSwappedSides(camera);
  Finding finding{
      "camera_intrinsics",
      is_impossible ? Severity::kError : Severity::kWarning,
      InWords(camera),
      "focal lengths of 0.2 to 10 times the width and a principal point near the middle",
      "",
      ""};
  ExplainIntrinsics(camera, &finding);
  return {finding};
}

}  // namespace

std::vector<Finding> CheckCamera(const ImportView& view) {
  std::vector<Finding> findings;
  std::vector<Camera> seen;
  for (const Frame& frame : view.sequence.frames) {
    const Camera& camera = view.sequence.CameraOf(frame);
    if (std::ranges::find(seen, camera) != seen.end()) continue;
    seen.push_back(camera);
    std::ranges::move(CheckIntrinsics(camera), std::back_inserter(findings));
  }
  return findings;
}

}  // namespace soslam
