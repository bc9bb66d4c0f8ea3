// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/folder_camera.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "base/error.h"
#include "dataset/camera_file.h"
#include "dataset/dataset_json.h"
#include "dataset/icl_nuim.h"
#include "dataset/text_file.h"
#include "geometry/image_size.h"

namespace soslam {
namespace {

// Numbers of a setting; none when one of its words is not a number.
std::optional<std::vector<double>> ParseNumbers(const std::string& text) {
  std::vector<double> numbers;
  try {
    for (const auto word : SplitWords(text)) numbers.push_back(ParseReal(word, "", "number"));
  } catch (const InputError&) {
    return std::nullopt;
  }
  return numbers;
}

[[noreturn]] void Refuse(const char* setting, const std::string& text, const char* expected) {
  throw SettingsError(fmt::format("{}: found '{}'; expected {}", setting, text, expected));
}

bool IsSizeInPixels(double width, double height) {
  const auto is_count = [](double number) {
    return number > 0.0 && number <= kMaxPixels && number == std::floor(number);
  };
  return is_count(width) && is_count(height) &&
         IsImageSize(static_cast<int>(width), static_cast<int>(height));
}

Camera CameraOfSetting(const ImportOptions& options) {
  constexpr const char* kExpected = "\"width height fx fy cx cy\", pixels";
  const std::string& text = options.folder.camera;
  const auto numbers = ParseNumbers(text);
  if (!numbers || numbers->size() != 6) Refuse("camera", text, kExpected);
  const double width = (*numbers)[0], height = (*numbers)[1];
  const double fx = (*numbers)[2], fy = (*numbers)[3], cx = (*numbers)[4], cy = (*numbers)[5];
  const bool y_is_up = options.format == DatasetFormat::kIclNuim;
  if (!IsSizeInPixels(width, height) || !(fx > 0.0) || !(y_is_up ? fy < 0.0 : fy > 0.0)) {
    throw SettingsError(fmt::format("camera: found '{}'; expected {}, fy {} 0", text, kExpected,
                                    y_is_up ? "below" : "above"));
  }
  const Camera camera{static_cast<int>(width), static_cast<int>(height), fx, fy, cx, cy};
  return y_is_up ? WithYDown(camera) : camera;
}

Distortion DistortionOfSetting(const std::string& text) {
  const auto numbers = ParseNumbers(text);
  const auto distortion = numbers ? DistortionOfCoefficients(*numbers) : std::nullopt;
  if (distortion) return *distortion;
  Refuse("distortion", text,
         "\"k1 k2 p1 p2 k3\" as OpenCV has them, or 4, 8, 12 or 14 of its numbers");
}

}  // namespace

Calibration ReadFolderCamera(const std::optional<std::filesystem::path>& camera_file,
                             const ImportOptions& options) {
  const bool y_is_up = options.format == DatasetFormat::kIclNuim;
  if (!options.folder.camera.empty() && !options.folder.camera_file.empty()) {
    throw SettingsError("camera, camera_file: found both; expected one of them");
  }
  Calibration read;
  if (!camera_file) {
    read.camera.camera = CameraOfSetting(options);
  } else if (y_is_up) {
    read.camera = ReadCamera(*camera_file, CameraYAxis::kUp);
  } else {
    read = ReadCameraFile(*camera_file);
  }
  std::optional<Distortion>& distortion = read.camera.distortion;
  if (!options.folder.distortion.empty()) {
    distortion = DistortionOfSetting(options.folder.distortion);
  }
  if (distortion == Distortion()) distortion.reset();
  if (distortion && y_is_up) {
    throw SettingsError(
        "distortion: found one for format icl_nuim; expected none, as its images "
        "are renders of a pinhole camera");
  }
  return read;
}

}  // namespace soslam
