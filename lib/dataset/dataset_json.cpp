// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/dataset_json.h"

#include <fmt/format.h>

#include <algorithm>

#include "artefact/json_file.h"
#include "base/error.h"
#include "dataset/dataset_keys.h"
#include "dataset/icl_nuim.h"
#include "dataset/json_entry.h"
#include "dataset/unit_quaternion.h"
#include "geometry/image_size.h"

namespace soslam {
namespace {

using nlohmann::json;
using Entry = JsonEntry;

// Parses each entry of a list; `name` is used in error messages.
template <typename Item>
std::vector<Item> ParseList(const json& list, const std::string& name,
                            Item (*parse)(const Entry&)) {
  if (!list.is_array()) throw InputError(name + ": is not a list");
  std::vector<Item> items;
  for (size_t i = 0; i < list.size(); ++i) {
    items.push_back(parse(Entry(list[i], fmt::format("{}[{}]", name, i))));
  }
  return items;
}

// ParseList for entries with ids, sorted by id; each id at most once.
template <typename Item>
std::vector<Item> ParseListWithIds(const json& list, const std::string& name,
                                   Item (*parse)(const Entry&)) {
  std::vector<Item> items = ParseList(list, name, parse);
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.id < b.id; });
  const auto twice = std::adjacent_find(items.begin(), items.end(),
                                        [](const Item& a, const Item& b) { return a.id == b.id; });
  if (twice != items.end()) {
    throw InputError(fmt::format("{}: id {} twice; expected once", name, twice->id));
  }
  return items;
}

SupportPlane ParsePlane(const Entry& entry) {
  entry.RefuseUnknownKeys(PlaneKeys());
  constexpr double kShortest = 1e-6;
  const Eigen::Vector3d normal = entry.Vector<3>("normal");
  const double length = normal.norm();
  if (!(length > kShortest)) entry.Refuse("normal", "a direction, not a zero vector");
  return {entry.Integer("id"), {normal / length, entry.Real("d") / length}};
}

Landmark ParseLandmark(const Entry& entry) {
  Landmark landmark;
  landmark.frame_from_object = {UnitQuaternion(entry.Vector<4>("quaternion_xyzw"), entry.place()),
                                entry.Vector<3>("center")};
  landmark.half_axes = entry.Vector<3>("half_axes");
  if (!(landmark.half_axes.minCoeff() > 0.0)) entry.Refuse("half_axes", "3 numbers above 0");
  return landmark;
}

bool HasLandmark(const Entry& entry) {
  return entry.Has("center") || entry.Has("quaternion_xyzw") || entry.Has("half_axes");
}

GroundTruth ParseGroundTruth(const Entry& entry) {
  return {ParseLandmark(entry), entry.Flag("mirror_symmetric", true),
          entry.Flag("mirror_symmetric_yz", false), entry.Flag("rotationally_symmetric", false)};
}

ListedObject ParseObject(const Entry& entry) {
  entry.RefuseUnknownKeys(ObjectKeys());
  ListedObject object;
  object.id = entry.Integer("id");
  object.label = entry.Text("label");
  if (entry.Has("support_plane")) object.plane_id = entry.Integer("support_plane");
  if (HasLandmark(entry)) object.ground_truth = ParseGroundTruth(entry);
  return object;
}

IgnoredThings ParseIgnored(const Entry& entry) {
  entry.RefuseUnknownKeys(IgnoredKeys());
  IgnoredThings things;
  if (entry.Has("label")) things.label = entry.Text("label");
  if (HasLandmark(entry)) things.volume_in_world = ParseLandmark(entry);
  if (!things.label && !things.volume_in_world) {
    throw InputError(entry.place() +
                     ": says nothing; expected a label, or center, quaternion_xyzw and half_axes");
  }
  return things;
}

std::optional<Distortion> LensOf(const Entry& entry) {
  std::vector<double> coefficients;
  if (entry.Has("distortion")) coefficients = entry.Reals("distortion");
  for (const char* name : {"model", "camera_model", "distortion_model"}) {
    if (entry.Has(name)) ParseLens(entry.Text(name), coefficients, entry.place());
  }
  return ParseLens("pinhole", coefficients, entry.place());
}

}  // namespace

Camera ParseCamera(const Entry& entry) {
  Camera camera{entry.Integer("width"), entry.Integer("height"), entry.Positive("fx"),
                entry.Real("fy"),       entry.Real("cx"),        entry.Real("cy")};
  if (camera.width <= 0) entry.Refuse("width", "pixels above 0");
  if (camera.height <= 0) entry.Refuse("height", "pixels above 0");
  if (!IsImageSize(camera.width, camera.height)) {
    entry.Refuse("height", fmt::format("at most {} pixels in all", kMaxPixels));
  }
  return camera;
}

LensCamera ReadCamera(const std::filesystem::path& path, CameraYAxis y_axis) {
  const json fields = ParseJsonFile(path);
  const Entry entry(fields, path.string());
  entry.RefuseUnknownKeys(CameraKeys());
  LensCamera read{ParseCamera(entry), LensOf(entry)};
  if (y_axis == CameraYAxis::kDown) {
    entry.Positive("fy");
    return read;
  }
  if (!(read.camera.fy < 0.0)) {
    entry.Refuse("fy", "that of a camera with y up, which is negative");
  }
  read.camera = WithYDown(read.camera);
  return read;
}

std::vector<SupportPlane> ReadPlanes(const std::filesystem::path& path) {
  std::vector<SupportPlane> planes =
      ParseListWithIds(ParseJsonFile(path), path.string(), &ParsePlane);
  if (planes.empty()) throw InputError(path.string() + ": has no plane; expected at least one");
  return planes;
}

ListedObjects ReadObjects(const std::filesystem::path& path) {
  const json document = ParseJsonFile(path);
  const std::string file = path.string();
  if (!document.is_object()) return {ParseListWithIds(document, file, &ParseObject)};
  const Entry entry(document, file);
  entry.RefuseUnknownKeys(ObjectsFileKeys());
  ListedObjects read = {ParseListWithIds(entry.Field("objects"), file + "#/objects", &ParseObject)};
  if (entry.Has("ignored")) {
    read.ignored = ParseList(entry.Field("ignored"), file + "#/ignored", &ParseIgnored);
  }
  return read;
}

}  // namespace soslam
