// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/model/appearance.h"
#include "support/random.h"

namespace soslam {

// A head with random weights, for features of some channels, as a file. Any part may be changed
// before it is written, or left out.
struct HeadFile {
  explicit HeadFile(int channels, int narrow = 2, int hidden = 3, int group_count = 2) {
    matrices["/narrow/weights"] = RandomMatrix(narrow, channels);
    matrices["/hidden/weights"] = RandomMatrix(hidden, 49 * narrow + 2 + group_count);
    matrices["/output/weights"] = RandomMatrix(kAzimuthBins + 4, hidden);
    matrices["/probe"] = RandomMatrix(channels, 49);
    matrices["/ratio_mean"] = RandomMatrix(group_count, 2);
    matrices["/ratio_sigma"] = cv::Mat(group_count, 2, CV_32F, cv::Scalar(10.0));
    vectors["/narrow/bias"] = RandomMatrix(1, narrow);
    vectors["/hidden/bias"] = RandomMatrix(1, hidden);
    vectors["/output/bias"] = RandomMatrix(1, kAzimuthBins + 4);
    vectors["/feature_mean"] = RandomMatrix(1, channels);
    vectors["/feature_scale"] = std::vector<float>(channels, 0.5F);
  }

  std::filesystem::path Write(const std::filesystem::path& path) const {
    Hdf5File file = CreateArtefact(path, kind, {});
    for (const auto& [name, text] : texts) file.WriteText("/", name, text);
    for (const auto& [name, number] : numbers) file.WriteNumber("/", name, number);
    for (const auto& [name, matrix] : matrices) file.WriteMatrix(name, matrix);
    for (const auto& [name, values] : vectors) file.WriteVector(name, values);
    file.Close();
    return path;
  }

  static cv::Mat RandomMatrix(int rows, int columns) {
    cv::Mat_<float> matrix(rows, columns);
    for (float& value : matrix) value = static_cast<float>(RandomUniform(-0.3, 0.3));
    return matrix;
  }

  std::string kind = "head";
  std::map<std::string, std::string> texts = {
      {"network_sha256", "of the network"},
      {"layers", "Mul 0, last"},
      {"groups",
       R"([{"name": "chair", "labels": ["chair", "stool"], "exponent": 0.5, "ratio_sigma_scale": 1.0},
           {"name": "bed", "labels": ["bed"], "exponent": 0.5, "ratio_sigma_scale": 0.0}])"}};
  std::map<std::string, double> numbers = {
      {"side_px", 64.0}, {"rgb_0_1", 0.0}, {"floor", 0.05}, {"direction_correlation_deg", 20.0}};
  std::map<std::string, cv::Mat> matrices;
  std::map<std::string, std::vector<float>> vectors;
};

}  // namespace soslam
