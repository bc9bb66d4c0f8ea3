// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/hdf5_artefact.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>

#include "base/error.h"

namespace soslam {
namespace {

// The header as JSON; null where there is none.
nlohmann::json HeaderOf(const Hdf5File& file) {
  if (!file.HasAttribute("/", kHeaderAttribute)) return {};
  std::istringstream text(file.ReadText("/", kHeaderAttribute));
  return ParseJsonText(text,
                       fmt::format("{}: attribute {}", file.path().string(), kHeaderAttribute));
}

}  // namespace

void WriteArtefactHeader(const std::string& kind, const ArtefactInfo& info, Hdf5File* file) {
  file->WriteText("/", kHeaderAttribute, ArtefactHeader(kind, info).dump());
}

Hdf5File OpenArtefact(const std::filesystem::path& path, const std::string& kind) {
  Hdf5File file = Hdf5File::Open(path);
  CheckArtefactHeader(HeaderOf(file), kind, path.string());
  return file;
}

bool IsHdf5(const std::filesystem::path& path) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  std::string begin(kSignature.size(), '\0');
  std::ifstream(path, std::ios::binary).read(begin.data(), static_cast<int>(begin.size()));
  return begin == kSignature;
}

nlohmann::json ReadArtefactHeader(const std::filesystem::path& path) {
  nlohmann::json header;
  if (IsHdf5(path)) {
    header = HeaderOf(Hdf5File::Open(path));
  } else {
    const nlohmann::json document = ParseJsonFile(path);
    if (document.is_object()) header = document.value("artefact", nlohmann::json());
  }
  if (!header.is_object() || !header.contains("kind") || !header["kind"].is_string()) {
    throw InputError(path.string() +
                     ": has no artefact header that names its kind; expected what a stage wrote");
  }
  return header;
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
