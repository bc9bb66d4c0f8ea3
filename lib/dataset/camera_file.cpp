// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/camera_file.h"

#include <string>

#include "dataset/colmap_model.h"
#include "dataset/dataset_json.h"
#include "dataset/nerfstudio.h"

namespace soslam {

Calibration ReadCameraFile(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension == ".yaml" || extension == ".yml" || extension == ".xml") {
    return ReadCalibration(path);
  }
  Calibration read;
  if (extension == ".txt" || extension == ".bin") {
    read.camera = ReadColmapCamera(path);
  } else {
    const auto of_nerfstudio = ReadNerfstudioCamera(path);
    read.camera = of_nerfstudio ? *of_nerfstudio : ReadCamera(path);
  }
  return read;
}

}  // namespace soslam
