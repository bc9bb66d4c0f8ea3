// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

namespace soslam {
namespace {

using nlohmann::json;

void LeaveOutCurves(json* data) {
  if (data->at("symmetries").empty()) return;
  for (json& symmetry : data->at("symmetries")) symmetry["curves"] = json::array();
  data->at("notes").push_back(
      "For lack of room the cost over yaw of single observations is left out.");
}

void KeepNumbersOnly(json* variant) {
  for (const char* key : {"objects", "outlines", "trajectory", "solver", "planes", "grids"}) {
    variant->erase(key);
  }
  variant->at("metrics")["objects"] = json::array();
  variant->at("numbers_only") = true;
}

// Keeps only the numbers of as many variants as necessary. Returns their names.
std::vector<std::string> KeepNumbersOnlyOfSome(size_t max_bytes, const BytesOfPage& bytes_of,
                                               json* data) {
  std::vector<std::string> names;
  for (const char* kind : {"frames", "views", "map"}) {
    for (json& variant : data->at("variants")) {
      if (variant.at("kind") != kind || bytes_of(*data) <= max_bytes) continue;
      KeepNumbersOnly(&variant);
      names.push_back(variant.at("name"));
    }
  }
  return names;
}

}  // namespace

void FitPageData(size_t max_bytes, const BytesOfPage& bytes_of, json* data) {
  if (bytes_of(*data) <= max_bytes) return;
  LeaveOutCurves(data);
  const auto reduced = KeepNumbersOnlyOfSome(max_bytes, bytes_of, data);
  if (reduced.empty()) return;
  data->at("notes").push_back(
      fmt::format("For lack of room only the numbers of {} are shown.", fmt::join(reduced, ", ")));
  if (reduced.size() < data->at("variants").size()) return;
  for (json& sequence : data->at("sequences")) {
    for (const char* key : {"frames", "objects", "detections", "planes", "segments"}) {
      sequence[key] = json::array();
    }
  }
}

}  // namespace soslam
