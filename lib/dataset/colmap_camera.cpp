// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/colmap_camera.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "geometry/image_size.h"

namespace soslam {
namespace {

const std::vector<ColmapCameraModel> kModels = {
    {0, "SIMPLE_PINHOLE", {"f", "cx", "cy"}},
    {1, "PINHOLE", {"fx", "fy", "cx", "cy"}},
    {2, "SIMPLE_RADIAL", {"f", "cx", "cy", "k1"}},
    {3, "RADIAL", {"f", "cx", "cy", "k1", "k2"}},
    {4, "OPENCV", {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"}},
    {6, "FULL_OPENCV", {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"}}};

[[noreturn]] void RefuseColmapModel(const std::string& model, const std::string& place) {
  std::vector<std::string> names;
  for (const ColmapCameraModel& known : kModels) names.emplace_back(known.name);
  throw InputError(fmt::format(
      "{}: camera model {} is not supported; expected one of {}; undistort the images first: "
      "colmap image_undistorter writes them with a model of PINHOLE cameras",
      place, model, fmt::join(names, ", ")));
}

// The value of a parameter; 0 if the model has none of this name.
double ValueOf(const char* name, const ColmapCameraModel& model, std::span<const double> values) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::string_view(model.parameters[i]) == name) return values[i];
  }
  return 0.0;
}

}  // namespace

const ColmapCameraModel& FindColmapCameraModel(std::string_view name, const std::string& place) {
  const auto found = std::ranges::find(kModels, name, &ColmapCameraModel::name);
  if (found == kModels.end()) RefuseColmapModel(fmt::format("'{}'", name), place);
  return *found;
}

const ColmapCameraModel& FindColmapCameraModel(int id, const std::string& place) {
  const auto found = std::ranges::find(kModels, id, &ColmapCameraModel::id);
  if (found != kModels.end()) return *found;
  const std::vector<std::pair<int, const char*>> others = {
      {5, "OPENCV_FISHEYE"},        {7, "FOV"},
      {8, "SIMPLE_RADIAL_FISHEYE"}, {9, "RADIAL_FISHEYE"},
      {10, "THIN_PRISM_FISHEYE"},   {11, "RAD_TAN_THIN_PRISM_FISHEYE"}};
  const auto other = std::ranges::find(others, id, &std::pair<int, const char*>::first);
  RefuseColmapModel(other != others.end() ? fmt::format("'{}'", other->second) : std::to_string(id),
                    place);
}

LensCamera CameraOfColmap(const ColmapCameraModel& model, std::int64_t width, std::int64_t height,
                          std::span<const double> parameters, const std::string& place) {
  const auto value = [&](const char* name) { return ValueOf(name, model, parameters); };
  const double fx = value("f") + value("fx"), fy = value("f") + value("fy");
  constexpr std::int64_t kMax = std::numeric_limits<int>::max();
  const bool is_size = width > 0 && width <= kMax && height > 0 && height <= kMax &&
                       IsImageSize(static_cast<int>(width), static_cast<int>(height));
  if (!is_size || !(fx > 0.0) || !(fy > 0.0)) {
    throw InputError(place + ": expected width, height and focal length above 0");
  }
  LensCamera read;
  read.camera = {static_cast<int>(width), static_cast<int>(height), fx, fy,
                 value("cx") - 0.5,       value("cy") - 0.5};
  const Distortion lens{value("k1"), value("k2"), value("p1"), value("p2"),
                        value("k3"), value("k4"), value("k5"), value("k6")};
  if (lens != Distortion()) read.distortion = lens;
  return read;
}

ColmapCameraText ToColmap(const LensCamera& camera) {
  const Camera& c = camera.camera;
  std::vector<double> values = {c.fx, c.fy, c.cx + 0.5, c.cy + 0.5};
  if (!camera.distortion) return {"PINHOLE", fmt::format("{}", fmt::join(values, ","))};
  const std::vector<double> lens = DistortionCoefficients(*camera.distortion);
  if (lens.size() > 8) {
    throw InputError(
        "distortion: has thin prisms or a tilted sensor; expected a lens that COLMAP "
        "has a model of: at most k1 k2 p1 p2 k3 k4 k5 k6");
  }
  const bool is_short = std::all_of(lens.begin() + 4, lens.end(), [](double k) { return k == 0; });
  values.insert(values.end(), lens.begin(), lens.begin() + (is_short ? 4 : lens.size()));
  values.resize(is_short ? 8 : 12);
  return {is_short ? "OPENCV" : "FULL_OPENCV", fmt::format("{}", fmt::join(values, ","))};
}

}  // namespace soslam
