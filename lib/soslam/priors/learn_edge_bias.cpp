// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

#include "soslam/constraints/tangency.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/model/label_groups.h"
#include "soslam/priors/learn_priors.h"

namespace soslam {
namespace {

constexpr size_t kMinEdges = 3;  // of one side, for an object to count
// Limits of the schema.
constexpr double kLeastBias = -1.0;
constexpr double kLargestBias = 0.4;

// Distances by which edges of an object's boxes lie outside its outline, as EdgeBias.
using EdgeOffsets = std::array<std::vector<double>, 4>;

struct RowOffsets {
  std::array<std::vector<double>, 4> medians;  // one per object with enough edges
  std::map<std::string, int> objects_of_sequence;
};

EdgeOffsets MeasureOffsets(const Sequence& sequence, const std::vector<int>& detections,
                           const ShapeExponents& shape_exponents) {
  EdgeOffsets offsets;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[index];
    Landmark in_camera = TrueLandmarkInCamera(sequence, detection).value();
    in_camera.shape_exponents = shape_exponents;
    if (!IsInFront(in_camera)) continue;
    const auto edges = BoxEdges(sequence.CameraOf(detection), detection.box, {}, 0.0);
    for (size_t side = 0; side < edges.size(); ++side) {
      if (detection.is_one_sided[side]) continue;
      const double inside_px =
          OutlineExcess(edges[side], in_camera, nullptr) * edges[side].sigma_px;
      const double extent_px = side % 2 == 0 ? detection.box.Width() : detection.box.Height();
      offsets[side].push_back(-inside_px / extent_px);
    }
  }
  return offsets;
}

}  // namespace

void LearnEdgeBias(const std::vector<Sequence>& sequences, double no_bias_weight,
                   SemanticRows* rows) {
  const auto row_of_name = RowsByName(*rows);
  std::map<size_t, RowOffsets> of_rows;  // by index of the row
  for (const Sequence& sequence : sequences) {
    const auto by_object = DetectionsByObject(sequence);
    for (size_t i = 0; i < sequence.objects.size(); ++i) {
      const Object& object = sequence.objects[i];
      const auto row = row_of_name.find(NormalisedLabel(object.label));
      if (!object.ground_truth || row == row_of_name.end()) continue;
      const auto offsets =
          MeasureOffsets(sequence, by_object[i], rows->rows[row->second].prior.shape_exponents);
      const auto is_enough = [](const auto& of_side) { return of_side.size() >= kMinEdges; };
      if (std::ranges::none_of(offsets, is_enough)) continue;
      RowOffsets& of_row = of_rows[row->second];
      ++of_row.objects_of_sequence[sequence.name];
      for (size_t side = 0; side < offsets.size(); ++side) {
        if (is_enough(offsets[side])) of_row.medians[side].push_back(*MedianOf(offsets[side]));
      }
    }
  }
  for (const auto& [index, offsets] : of_rows) {
    SemanticRow& row = rows->rows[index];
    for (size_t side = 0; side < offsets.medians.size(); ++side) {
      const std::vector<double>& medians = offsets.medians[side];
      row.prior.edge_bias[side] = 0.0;
      if (medians.empty()) continue;
      const double bias = std::accumulate(medians.begin(), medians.end(), 0.0) /
                          (no_bias_weight + static_cast<double>(medians.size()));
      row.prior.edge_bias[side] =
          std::round(std::clamp(bias, kLeastBias, kLargestBias) * 1e4) / 1e4;
    }
    std::vector<std::string> cited;
    for (const auto& [name, count] : offsets.objects_of_sequence) {
      cited.push_back(fmt::format("{} of {}", count, name));
    }
    row.source += fmt::format("; edge bias: {}", fmt::join(cited, ", "));
  }
}

}  // namespace soslam
