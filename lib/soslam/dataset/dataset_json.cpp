// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/dataset_json.h"

#include <fmt/format.h>

#include <algorithm>

#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/image_size.h"

namespace soslam {
namespace {

using nlohmann::json;
using Entry = JsonEntry;

// Hints for other names of position, size and label.
const std::vector<KeyHint> kPlaceHints = {
    {{"position", "translation", "location"}, "the middle of the object is read as \"center\""},
    {{"size", "dimensions", "extent", "scale"},
     "the size is read as \"half_axes\", half of it along x, y, z"},
    {{"yaw", "rotation", "orientation", "quaternion", "quaternion_wxyz"},
     "the orientation is read as \"quaternion_xyzw\"; that of a yaw about z is "
     "[0, 0, sin(yaw / 2), cos(yaw / 2)]"},
    {{"category", "class"}, "the category is read as \"label\""}};

std::vector<KeyHint> WithPlaceHints(std::vector<KeyHint> hints) {
  hints.insert(hints.end(), kPlaceHints.begin(), kPlaceHints.end());
  return hints;
}

const KnownKeys kCameraKeys = {
    {"width", "height", "fx", "fy", "cx", "cy", "distortion", "model", "camera_model",
     "distortion_model", "name", "description", "comment", "source", "fps", "depth_scale"},
    {{{"k1", "k2", "k3", "p1", "p2", "distortion_coefficients", "distortion_coeffs", "dist_coeffs",
       "dist", "D", "k"},
      "k1, k2, p1, p2, k3 are read as \"distortion\": [k1, k2, p1, p2, k3]"},
     {{"skew", "s"}, "pixels are not skewed here; leave it out if it is 0"},
     {{"f"}, "a focal length is read as \"fx\" and \"fy\""},
     {{"K", "intrinsics", "camera_matrix"},
      "the intrinsics are read as \"fx\", \"fy\", \"cx\", \"cy\", pixels"},
     {{"image_width", "image_height", "w", "h"}, "the size is read as \"width\" and \"height\""}}};

// Keys of an entry of planes.json.
const KnownKeys kPlaneKeys = {
    {"id", "normal", "d", "scene_axis", "label", "name", "description", "comment"},
    {{{"offset", "distance", "point", "equation"},
      "a plane is normal . x + d = 0, read as \"normal\" and \"d\""}}};

// Keys of an object of objects.json.
const KnownKeys kObjectKeys = {
    {"id", "label", "support_plane", "center", "quaternion_xyzw", "half_axes", "rests_on",
     "mirror_symmetric", "mirror_symmetric_yz", "rotationally_symmetric", "model", "name",
     "description", "comment", "source"},
    WithPlaceHints({{{"plane"}, "the plane is read as \"support_plane\", an id of planes.json"},
                    {{"object_id"}, "the id is read as \"id\""},
                    {{"ignored"},
                     "what is not to be judged is listed beside the objects: "
                     "{\"objects\": [...], \"ignored\": [...]}"}})};

// Keys of an entry of "ignored" in objects.json.
const KnownKeys kIgnoredKeys = {
    {"label", "center", "quaternion_xyzw", "half_axes", "name", "description", "comment", "source"},
    kPlaceHints};

// Keys of objects.json when it is not a list.
const KnownKeys kObjectsFileKeys = {
    {"objects", "ignored", "name", "description", "comment", "source"}};

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
  std::ranges::sort(items, {}, &Item::id);
  const auto twice = std::ranges::adjacent_find(items, {}, &Item::id);
  if (twice != items.end()) {
    throw InputError(fmt::format("{}: id {} twice; expected once", name, twice->id));
  }
  return items;
}

SupportPlane ParsePlane(const Entry& entry) {
  entry.RefuseUnknownKeys(kPlaneKeys);
  constexpr double kShortest = 1e-6;
  const Eigen::Vector3d normal = entry.Vector<3>("normal");
  const double length = normal.norm();
  if (!(length > kShortest)) entry.Refuse("normal", "a direction, not a zero vector");
  SupportPlane plane{entry.Integer("id"), {normal / length, entry.Real("d") / length}};
  if (entry.Has("scene_axis")) {
    const Eigen::Vector3d axis = entry.Vector<3>("scene_axis");
    const Eigen::Vector3d& up = plane.plane_in_world.normal;
    const Eigen::Vector3d in_plane = axis - axis.dot(up) * up;
    if (!(in_plane.norm() > kShortest)) {
      entry.Refuse("scene_axis", "a direction in the plane, not along its normal");
    }
    plane.scene_axis_in_world = in_plane.normalized();
  }
  return plane;
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
  return entry.Has("center") || entry.Has("quaternion_xyzw") || entry.Has("half_axes") ||
         entry.Has("rests_on");
}

ListedObject ParseObject(const Entry& entry) {
  entry.RefuseUnknownKeys(kObjectKeys);
  ListedObject object;
  object.id = entry.Integer("id");
  object.label = entry.Text("label");
  if (entry.Has("support_plane")) object.plane_id = entry.Integer("support_plane");
  if (!HasLandmark(entry)) return object;
  Landmark landmark = ParseLandmark(entry);
  if (entry.Has("rests_on")) {
    const auto* const face = std::ranges::find(kRestingFaceNames, entry.Text("rests_on"));
    if (face == kRestingFaceNames.end()) entry.Refuse("rests_on", "bottom, back or side");
    landmark.rests_on = kRestingFaces[static_cast<size_t>(face - kRestingFaceNames.begin())];
  }
  if (landmark.rests_on != RestingFace::kBottom && entry.Flag("rotationally_symmetric", false)) {
    entry.Refuse("rotationally_symmetric", "false of what does not rest on its bottom");
  }
  object.ground_truth = {landmark, entry.Flag("mirror_symmetric", true),
                         entry.Flag("mirror_symmetric_yz", false),
                         entry.Flag("rotationally_symmetric", false)};
  return object;
}

IgnoredThings ParseIgnored(const Entry& entry) {
  entry.RefuseUnknownKeys(kIgnoredKeys);
  IgnoredThings things;
  if (entry.Has("label")) things.label = entry.Text("label");
  if (HasLandmark(entry)) things.volume_in_world = ParseLandmark(entry);
  if (!things.label && !things.volume_in_world) {
    throw InputError(entry.place() +
                     ": says nothing; expected a label, or center, quaternion_xyzw and half_axes");
  }
  return things;
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
  entry.RefuseUnknownKeys(kCameraKeys);
  LensCamera read{ParseCamera(entry), {}};
  std::vector<double> coefficients;
  if (entry.Has("distortion")) coefficients = entry.Reals("distortion");
  for (const char* name : {"model", "camera_model", "distortion_model"}) {
    if (entry.Has(name)) ParseLens(entry.Text(name), coefficients, entry.place());
  }
  read.distortion = ParseLens("pinhole", coefficients, entry.place());
  if (y_axis == CameraYAxis::kDown) {
    entry.Positive("fy");
    return read;
  }
  if (!(read.camera.fy < 0.0)) {
    entry.Refuse("fy", "that of a camera with y up, which is negative");
  }
  read.camera.fy = -read.camera.fy;
  return read;
}

std::string CameraText(const LensCamera& camera, const std::string& source) {
  const Camera& c = camera.camera;
  nlohmann::ordered_json document = {{"width", c.width}, {"height", c.height}, {"fx", c.fx},
                                     {"fy", c.fy},       {"cx", c.cx},         {"cy", c.cy}};
  if (camera.distortion) document["distortion"] = DistortionCoefficients(*camera.distortion);
  document["source"] = source;
  return document.dump() + "\n";
}

std::string SourceOfCamera(const std::filesystem::path& path) {
  const json fields = ParseJsonFile(path);
  const bool has_source = fields.is_object() && fields.contains("source");
  return has_source && fields["source"].is_string() ? fields["source"].get<std::string>() : "";
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
  entry.RefuseUnknownKeys(kObjectsFileKeys);
  ListedObjects read = {ParseListWithIds(entry.Field("objects"), file + "#/objects", &ParseObject)};
  if (entry.Has("ignored")) {
    read.ignored = ParseList(entry.Field("ignored"), file + "#/ignored", &ParseIgnored);
  }
  return read;
}

}  // namespace soslam
