// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "soslam/artefact/described_json.h"
#include "soslam/base/error.h"
#include "soslam/exchange/exports.h"
#include "soslam/geometry/distortion.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

ordered_json Intrinsics(const Camera& camera) {
  return {{"w", camera.width}, {"h", camera.height},    {"fl_x", camera.fx},
          {"fl_y", camera.fy}, {"cx", camera.cx + 0.5}, {"cy", camera.cy + 0.5}};
}

}  // namespace

std::string TransformsText(const World& world, const fs::path& dataset) {
  std::vector<WorldFrame> frames = world.frames;
  std::erase_if(frames, [](const WorldFrame& frame) { return frame.image.empty(); });
  const bool is_one_camera = std::ranges::all_of(
      frames, [&](const WorldFrame& frame) { return frame.camera == frames.front().camera; });
  ordered_json document = {{"camera_model", "OPENCV"}};
  if (is_one_camera) document.update(Intrinsics(frames.front().camera));
  const Distortion lens = world.image_distortion.value_or(Distortion());
  if (DistortionCoefficients(lens).size() > 5) {
    throw InputError(
        "distortion: has k4 and more coefficients; expected a lens that nerfstudio has a model of: "
        "k1, k2, k3, p1, p2");
  }
  document.update(ordered_json{
      {"k1", lens.k1}, {"k2", lens.k2}, {"k3", lens.k3}, {"p1", lens.p1}, {"p2", lens.p2}});
  for (const WorldFrame& frame : frames) {
    ordered_json entry = {{"file_path", (dataset / frame.image).generic_string()}};
    if (!is_one_camera) entry.update(Intrinsics(frame.camera));
    Eigen::Matrix4d world_from_opengl = frame.world_from_camera.Matrix();
    world_from_opengl.block<3, 2>(0, 1) *= -1.0;
    entry["transform_matrix"] = world_from_opengl;
    document["frames"].push_back(entry);
  }
  return document.dump(1) + "\n";
}

}  // namespace soslam
