// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/lens_camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "base/error.h"

namespace soslam {
namespace {

// A name of OpenCV's model and the possible numbers of its coefficients.
struct LensModel {
  const char* name;
  std::vector<size_t> counts;
};

const std::vector<LensModel>& LensModels() {
  static const std::vector<LensModel> models = {{"none", {0, 4, 5}},  // all of them 0
                                                {"pinhole", {0, 4, 5, 8, 12, 14}},
                                                {"perspective", {0, 4, 5, 8, 12, 14}},
                                                {"simplepinhole", {0, 4, 5}},
                                                {"opencv", {4, 5, 8, 12, 14}},
                                                {"plumbbob", {4, 5}},
                                                {"radtan", {4, 5}},
                                                {"radialtangential", {4, 5}},
                                                {"brown", {4, 5}},
                                                {"brownconrady", {4, 5}},
                                                {"simpleradial", {4, 5}},
                                                {"radial", {4, 5}},
                                                {"rationalpolynomial", {8, 12, 14}},
                                                {"fullopencv", {8}},
                                                {"thinprism", {12, 14}}};
  return models;
}

// Normalised model name: lower case, without word separators.
std::string PlainName(const std::string& model) {
  std::string name;
  for (const char c : model) {
    if (c == '_' || c == '-' || c == ' ') continue;
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

// True for a wide-angle model, whose field of view exceeds that of a pinhole image.
bool IsWideAngle(const std::string& plain_name) {
  for (const char* part : {"fisheye", "equi", "kannala", "kb", "omni", "mei", "unified", "ucm",
                           "doublesphere", "fov", "atan", "scaramuzza", "spherical", "ftheta"}) {
    if (plain_name.find(part) != std::string::npos) return true;
  }
  return plain_name == "ds";
}

[[noreturn]] void RefuseModel(const std::string& model, const std::string& place) {
  if (IsWideAngle(PlainName(model))) {
    throw InputError(fmt::format(
        "{}: lens model '{}' is not supported; expected OpenCV's for pinhole cameras: undistort "
        "the images first (cv::fisheye::undistortImage, COLMAP's image_undistorter) and give the "
        "camera of the undistorted ones",
        place, model));
  }
  throw InputError(
      fmt::format("{}: lens model '{}' is not known; expected pinhole, opencv, plumb_bob, radtan, "
                  "rational_polynomial or none: OpenCV's for pinhole cameras",
                  place, model));
}

}  // namespace

std::optional<Distortion> ParseLens(const std::string& model, std::span<const double> coefficients,
                                    const std::string& place) {
  const std::string name = PlainName(model);
  const auto found = std::ranges::find(LensModels(), name,
                                       [](const LensModel& m) -> std::string { return m.name; });
  if (found == LensModels().end()) RefuseModel(model, place);
  const bool are_zero = std::ranges::all_of(coefficients, [](double k) { return k == 0.0; });
  if (std::ranges::find(found->counts, coefficients.size()) == found->counts.end() ||
      (name == "none" && !are_zero)) {
    const size_t shown = std::min<size_t>(coefficients.size(), 14);
    throw InputError(fmt::format(
        "{}: distortion has {} numbers ({}) for lens model '{}'; expected {}, in OpenCV's order: "
        "k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]]",
        place, coefficients.size(), fmt::join(coefficients.first(shown), " "), model,
        name == "none" ? "none but 0" : fmt::format("{}", fmt::join(found->counts, ", "))));
  }
  if (coefficients.empty()) return std::nullopt;
  return DistortionOfCoefficients(coefficients);
}

}  // namespace soslam
