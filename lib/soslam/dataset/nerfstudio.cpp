// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/nerfstudio.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/dataset/image_path.h"
#include "soslam/dataset/json_entry.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/image_size.h"
#include "soslam/image/image_format.h"

namespace soslam {
namespace {

using nlohmann::json;

constexpr std::array kNerfstudioKeys = {
    "w",  "h",  "fl_x", "fl_y", "cx", "cy", "camera_angle_x", "k1", "k2",
    "k3", "k4", "k5",   "k6",   "p1", "p2", "camera_model"};

double RealOr(const JsonEntry& entry, const char* name, double value) {
  return entry.Has(name) ? entry.Real(name) : value;
}

std::vector<JsonEntry> ListFrames(const JsonEntry& all) {
  return ListEntries(all.List("frames"), all.place() + "#/frames");
}

// The path of a frame's image, with the extension that Blender's scenes leave out: that of a file
// in the folder, otherwise .png.
std::string FindImage(const JsonEntry& frame, const std::filesystem::path& folder) {
  const std::string image = frame.Text("file_path");
  if (std::filesystem::path(image).has_extension()) return image;
  for (const char* extension : {".png", ".jpg", ".jpeg", ".PNG", ".JPG", ".JPEG"}) {
    if (IsFile(folder / (image + extension))) return image + extension;
  }
  return image + ".png";
}

LensCamera ParseNerfstudioCamera(const JsonEntry& entry) {
  for (const char* side : {"w", "h"}) {
    if (!entry.Has(side)) {
      throw InputError(
          fmt::format("{}: {} is missing; expected it, or the images that the frames name, "
                      "not turned by EXIF",
                      entry.place(), side));
    }
    if (!IsWholeImageSize(entry.Real(side), 1.0)) entry.Refuse(side, "pixels above 0");
  }
  Camera camera{static_cast<int>(entry.Real("w")), static_cast<int>(entry.Real("h"))};
  if (!IsImageSize(camera.width, camera.height)) {
    entry.Refuse("h", fmt::format("at most {} pixels in all", kMaxPixels));
  }
  if (entry.Has("fl_x") || !entry.Has("camera_angle_x")) {
    camera.fx = entry.Positive("fl_x");
  } else {
    const double angle = entry.Positive("camera_angle_x");
    if (angle >= std::numbers::pi) entry.Refuse("camera_angle_x", "radians below pi");
    camera.fx = 0.5 * camera.width / std::tan(0.5 * angle);
  }
  camera.fy = entry.Has("fl_y") ? entry.Positive("fl_y") : camera.fx;
  camera.cx = RealOr(entry, "cx", 0.5 * camera.width) - 0.5;
  camera.cy = RealOr(entry, "cy", 0.5 * camera.height) - 0.5;
  std::vector<double> coefficients;
  for (const char* name : {"k1", "k2", "p1", "p2", "k3"}) {
    coefficients.push_back(RealOr(entry, name, 0.0));
  }
  std::string model = entry.Has("camera_model") ? entry.Text("camera_model") : "OPENCV";
  if (entry.Flag("is_fisheye", false)) model = "fisheye";  // written by instant-ngp
  if (model == "FULL_OPENCV") model = "OPENCV";  // no further coefficients are in these files
  const auto distortion = ParseLens(model, coefficients, entry.place());
  for (const char* name : {"k4", "k5", "k6"}) {
    if (RealOr(entry, name, 0.0) != 0.0) entry.Refuse(name, "0: no lens model here has it");
  }
  return {camera, distortion};
}

// The camera of each frame, by its own values or those of the file.
std::vector<PlacedCamera> ListCameras(const json& document, const std::filesystem::path& path) {
  const JsonEntry all(document, path.string());
  json common = document;
  common.erase("frames");
  const auto camera_of = [](const json& fields, const std::string& place) {
    return PlacedCamera{place, ParseNerfstudioCamera(JsonEntry(fields, place))};
  };
  if (!all.Has("frames")) return {camera_of(common, all.place())};
  const std::vector<JsonEntry> frames = ListFrames(all);
  const auto has_size = [](const JsonEntry& entry) { return entry.Has("w") || entry.Has("h"); };
  if (!has_size(all) && std::ranges::none_of(frames, has_size)) {
    for (const JsonEntry& frame : frames) {
      const std::string image = FindImage(frame, path.parent_path());
      const auto header = ReadImageHeader(ImagePath(path.parent_path(), image, frame.place()));
      if (!header) continue;
      // An image that EXIF turns has two sizes.
      if (!header->IsTurnedByAQuarter()) {
        common.update({{"w", header->stored.width}, {"h", header->stored.height}});
      }
      break;
    }
  }
  std::vector<PlacedCamera> cameras;
  for (const JsonEntry& frame : frames) {
    json fields = common;
    bool has_own = false;
    for (const char* key : kNerfstudioKeys) {
      if (!frame.Has(key)) continue;
      fields[key] = frame.Field(key);
      has_own = true;
    }
    cameras.push_back(camera_of(fields, has_own ? frame.place() : all.place()));
  }
  if (cameras.empty()) cameras.push_back(camera_of(common, all.place()));
  return cameras;
}

}  // namespace

std::optional<LensCamera> ReadNerfstudioCamera(const std::filesystem::path& path,
                                               std::vector<Finding>* findings) {
  const json document = ParseJsonFile(path);
  if (!document.is_object()) return std::nullopt;
  const JsonEntry entry(document, path.string());
  if (!entry.Has("frames") && !entry.Has("fl_x") && !entry.Has("camera_angle_x")) {
    return std::nullopt;
  }
  return OneCamera(ListCameras(document, path), "images with one zoom and focus", findings);
}

std::vector<NamedPose> ReadNerfstudioPoses(const std::filesystem::path& path,
                                           std::vector<Finding>* findings) {
  const json document = ParseJsonFile(path);
  const JsonEntry entry(document, path.string());
  std::vector<NamedPose> poses;
  const Eigen::Quaterniond half_turn_about_x(0.0, 1.0, 0.0, 0.0);
  for (const JsonEntry& frame : ListFrames(entry)) {
    const auto matrix = MatrixFromJson<Eigen::Matrix4d>(frame.Field("transform_matrix"));
    if (!matrix) frame.Refuse("transform_matrix", "4 rows of 4 numbers");
    const Rigid3d world_from_opengl = RigidMotion(*matrix, frame.place());
    poses.push_back(
        {frame.place(),
         frame.Text("file_path"),
         {world_from_opengl.rotation * half_turn_about_x, world_from_opengl.translation}});
  }
  if (poses.empty()) entry.Refuse("frames", "at least one frame");
  const double scale = entry.Has("applied_scale") ? entry.Positive("applied_scale") : 1.0;
  if (scale == 1.0) return poses;
  findings->push_back(
      {"applied_scale", Severity::kWarning,
       fmt::format(
           "{}: applied_scale is {:g}: the poses are those of the reconstruction times that",
           path.filename().string(), scale),
       "poses in metres", "a program that made the scene larger or smaller, to fit into a cube",
       fmt::format("multiply translations by {:g} where the reconstruction was in metres; nothing "
                   "where applied_scale made metres of it",
                   1.0 / scale)});
  return poses;
}

std::vector<ListedImage> ReadNerfstudioImages(const std::filesystem::path& path) {
  const json document = ParseJsonFile(path);
  std::vector<ListedImage> images;
  for (const JsonEntry& frame : ListFrames(JsonEntry(document, path.string()))) {
    images.push_back({0.0, FindImage(frame, path.parent_path())});
  }
  std::ranges::stable_sort(
      images, {}, [](const ListedImage& image) { return std::filesystem::path(image.image); });
  for (size_t i = 0; i < images.size(); ++i) images[i].timestamp = static_cast<double>(i);
  if (images.empty()) throw InputError(path.string() + ": lists no image");
  return images;
}

}  // namespace soslam
