// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/hdf5_artefact.h"

#include <nlohmann/json.hpp>

namespace soslam {
namespace {

constexpr const char* kHeaderAttribute = "artefact";

}  // namespace

void WriteArtefactHeader(const std::string& kind, const ArtefactInfo& info, Hdf5File* file) {
  file->WriteText("/", kHeaderAttribute, ArtefactHeader(kind, info).dump());
}

Hdf5File OpenArtefact(const std::filesystem::path& path, const std::string& kind) {
  Hdf5File file = Hdf5File::Open(path);
  // A header that is missing or not JSON is "discarded", which the check refuses.
  const std::string text =
      file.HasAttribute("/", kHeaderAttribute) ? file.ReadText("/", kHeaderAttribute) : "";
  constexpr bool kAllowExceptions = false;
  CheckArtefactHeader(nlohmann::json::parse(text, nullptr, kAllowExceptions), kind, path.string());
  return file;
}

void WritePixels(const std::string& name, const std::vector<Eigen::Vector2f>& pixels,
                 Hdf5File* file) {
  cv::Mat matrix(static_cast<int>(pixels.size()), 2, CV_32FC1);
  for (int i = 0; i < matrix.rows; ++i) {
    const Eigen::Vector2f& pixel = pixels[static_cast<size_t>(i)];
    matrix.at<float>(i, 0) = pixel.x();
    matrix.at<float>(i, 1) = pixel.y();
  }
  file->WriteMatrix(name, matrix);
}

std::vector<Eigen::Vector2f> ReadPixels(const Hdf5File& file, const std::string& name, int count) {
  const cv::Mat matrix = file.ReadMatrix(name, CV_32FC1, count, 2);
  std::vector<Eigen::Vector2f> pixels;
  for (int i = 0; i < matrix.rows; ++i) {
    pixels.emplace_back(matrix.at<float>(i, 0), matrix.at<float>(i, 1));
  }
  return pixels;
}

}  // namespace soslam
