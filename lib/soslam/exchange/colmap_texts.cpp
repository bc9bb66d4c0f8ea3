// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/dataset/colmap_model.h"
#include "soslam/exchange/exports.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

int ImageId(int frame_id) { return frame_id + 1; }

}  // namespace

ColmapTexts ColmapModelTexts(const World& world, const fs::path& images) {
  ColmapTexts texts;
  texts.cameras = "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n";
  texts.images = "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME\n# POINTS2D[] as X Y POINT3D_ID\n";
  texts.points3D = "# POINT3D_ID X Y Z R G B ERROR TRACK[] as IMAGE_ID POINT2D_IDX\n";
  struct ImagePoints {
    std::string words;
    int count = 0;
  };
  std::map<int, ImagePoints> seen;  // by frame id
  for (const WorldFrame& frame : world.frames) {
    if (!frame.image.empty()) seen[frame.id];
  }
  for (size_t i = 0; i < world.points.size(); ++i) {
    const WorldPoint& point = world.points[i];
    texts.points3D += fmt::format("{} {} {} {}", i + 1, fmt::join(point.position_in_world, " "),
                                  fmt::join(point.rgb, " "), point.reprojection_error_px);
    for (const PointObservation& observation : point.observations) {
      const auto image = seen.find(observation.frame_id);
      if (image == seen.end()) continue;
      texts.points3D += fmt::format(" {} {}", ImageId(image->first), image->second.count++);
      image->second.words +=
          fmt::format("{}{} {} {}", image->second.words.empty() ? "" : " ",
                      observation.pixel.x() + 0.5, observation.pixel.y() + 0.5, i + 1);
    }
    texts.points3D += "\n";
  }
  std::vector<Camera> cameras;
  for (const WorldFrame& frame : world.frames) {
    if (frame.image.empty()) continue;
    auto camera = std::ranges::find(cameras, frame.camera);
    if (camera == cameras.end()) {
      camera = cameras.insert(cameras.end(), frame.camera);
      auto [model, parameters] = ToColmap({frame.camera, world.image_distortion});
      std::ranges::replace(parameters, ',', ' ');
      texts.cameras += fmt::format("{} {} {} {} {}\n", cameras.size(), model, frame.camera.width,
                                   frame.camera.height, parameters);
    }
    const std::string name = fs::path(frame.image).lexically_relative(images).generic_string();
    if (name.find_first_of(" \t\r\n") != std::string::npos) {
      throw InputError(
          fmt::format("frame {}: image '{}' has a blank in its name, at which COLMAP cuts "
                      "it off; expected a name without blanks",
                      frame.id, frame.image));
    }
    const Rigid3d camera_from_world = frame.world_from_camera.Inverse();
    const Eigen::Quaterniond& q = camera_from_world.rotation;
    texts.images += fmt::format("{} {} {} {} {} {} {} {}\n{}\n", ImageId(frame.id), q.w(), q.x(),
                                q.y(), q.z(), fmt::join(camera_from_world.translation, " "),
                                camera - cameras.begin() + 1, name, seen.at(frame.id).words);
  }
  return texts;
}

}  // namespace soslam
