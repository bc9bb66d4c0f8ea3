// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/folder_camera.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "dataset/dataset_json.h"
#include "dataset/icl_nuim.h"
#include "dataset/text_file.h"
#include "geometry/image_size.h"

namespace soslam {
namespace {

// The numbers of a setting with this many of them.
template <size_t kSize>
std::array<double, kSize> ParseSetting(const char* setting, const std::string& text,
                                       const char* expected) {
  const auto words = SplitWords(text);
  std::array<double, kSize> numbers;
  bool is_valid = words.size() == kSize;
  try {
    for (size_t i = 0; is_valid && i < kSize; ++i) {
      numbers[i] = ParseReal(words[i], setting, "number");
    }
  } catch (const InputError&) {
    is_valid = false;
  }
  if (!is_valid) {
    throw SettingsError(fmt::format("{}: found '{}'; expected {}", setting, text, expected));
  }
  return numbers;
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
  const auto [width, height, fx, fy, cx, cy] = ParseSetting<6>("camera", text, kExpected);
  const bool y_is_up = options.format == DatasetFormat::kIclNuim;
  if (!IsSizeInPixels(width, height) || !(fx > 0.0) || !(y_is_up ? fy < 0.0 : fy > 0.0)) {
    throw SettingsError(fmt::format("camera: found '{}'; expected {}, fy {} 0", text, kExpected,
                                    y_is_up ? "below" : "above"));
  }
  const Camera camera{static_cast<int>(width), static_cast<int>(height), fx, fy, cx, cy};
  return y_is_up ? WithYDown(camera) : camera;
}

std::optional<Distortion> DistortionOfSetting(const std::string& text) {
  const auto [k1, k2, p1, p2, k3] =
      ParseSetting<5>("distortion", text, "\"k1 k2 p1 p2 k3\" as OpenCV has them");
  return Distortion{k1, k2, p1, p2, k3};
}

}  // namespace

FolderCamera ReadFolderCamera(const std::optional<std::filesystem::path>& camera_json,
                              const ImportOptions& options) {
  const bool y_is_up = options.format == DatasetFormat::kIclNuim;
  FolderCamera read;
  if (camera_json) {
    read.camera = y_is_up ? ReadCameraWithYUp(*camera_json) : ReadCamera(*camera_json);
    read.distortion = ReadDistortion(*camera_json);
  } else {
    read.camera = CameraOfSetting(options);
  }
  if (!options.folder.distortion.empty()) {
    read.distortion = DistortionOfSetting(options.folder.distortion);
  }
  if (read.distortion == Distortion()) read.distortion.reset();
  if (read.distortion && y_is_up) {
    throw SettingsError(
        "distortion: found one for format icl_nuim; expected none, as its images "
        "are renders of a pinhole camera");
  }
  return read;
}

}  // namespace soslam
