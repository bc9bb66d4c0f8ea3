// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dataset/calibration_file.h"

namespace soslam {

// Camera model of COLMAP with the names of its parameters, in order. "f" is both focal lengths.
struct ColmapCameraModel {
  int id;  // in binary files
  const char* name;
  std::vector<const char*> parameters;
};

// Throws InputError, naming `place`, for a model that OpenCV's lens model does not include.
const ColmapCameraModel& FindColmapCameraModel(std::string_view name, const std::string& place);
const ColmapCameraModel& FindColmapCameraModel(int id, const std::string& place);

// The camera with these parameters, one per name. Throws InputError, naming `place`, for a size or
// a focal length that no camera has.
LensCamera CameraOfColmap(const ColmapCameraModel& model, std::int64_t width, std::int64_t height,
                          std::span<const double> parameters, const std::string& place);

// The inverse of CameraOfColmap: name and parameters ("500,500,320,240") of the smallest model that
// includes the lens.
struct ColmapCameraText {
  std::string model;
  std::string parameters;
};
// Throws InputError for thin prisms and tilted sensors, which COLMAP's models do not have.
ColmapCameraText ToColmap(const LensCamera& camera);

}  // namespace soslam
