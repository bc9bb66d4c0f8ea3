// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/oa_slam_boxes.h"

#include <fmt/format.h>

#include "artefact/json_file.h"
#include "base/error.h"
#include "dataset/json_entry.h"

namespace soslam {
namespace {

using nlohmann::json;

LabelledBox ParseDetection(const JsonEntry& entry, const std::string& image,
                           const std::vector<std::string>& labels) {
  const int category = entry.Integer("category_id");
  if (category < 0 || category >= static_cast<int>(labels.size())) {
    entry.Refuse("category_id", fmt::format("0 to {}", labels.size() - 1));
  }
  const Eigen::Vector4d corners = entry.Vector<4>("bbox");
  if (corners[2] < corners[0] || corners[3] < corners[1]) {
    entry.Refuse("bbox", "[x1, y1, x2, y2] with x1 <= x2 and y1 <= y2");
  }
  return {entry.place(), image, labels[static_cast<size_t>(category)],
          entry.Real("detection_score"),
          FromCornerOrigin({corners[0], corners[1], corners[2], corners[3]})};
}

}  // namespace

std::vector<LabelledBox> ReadOaSlamBoxes(const std::filesystem::path& path,
                                         const std::vector<std::string>& labels) {
  const json images = ParseJsonFile(path);
  if (!images.is_array()) throw InputError(path.string() + ": is not a list of images");
  std::vector<LabelledBox> boxes;
  for (size_t i = 0; i < images.size(); ++i) {
    const JsonEntry image(images[i], fmt::format("{}#/{}", path.string(), i));
    const std::string name = image.Text("file_name");
    const json& detections = image.List("detections");
    for (size_t k = 0; k < detections.size(); ++k) {
      const JsonEntry entry(detections[k], fmt::format("{}/detections/{}", image.place(), k));
      boxes.push_back(ParseDetection(entry, name, labels));
    }
  }
  return boxes;
}

}  // namespace soslam
