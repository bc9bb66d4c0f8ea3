// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/dataset_keys.h"

namespace soslam {
namespace {

// Hints for keys of other programs.
constexpr const char* kCoefficients =
    "k1, k2, p1, p2, k3 are read as \"distortion\": [k1, k2, p1, p2, k3]";
constexpr const char* kMatrix = "the intrinsics are read as \"fx\", \"fy\", \"cx\", \"cy\", pixels";
constexpr const char* kOffset = "a plane is normal . x + d = 0, read as \"normal\" and \"d\"";
constexpr const char* kCenter = "the middle of the object is read as \"center\"";
constexpr const char* kHalfAxes = "the size is read as \"half_axes\", half of it along x, y, z";
constexpr const char* kQuaternion =
    "the orientation is read as \"quaternion_xyzw\"; that of a yaw about z is "
    "[0, 0, sin(yaw / 2), cos(yaw / 2)]";

// Adds hints for other names of position, size and label.
std::vector<KeyHint> WithPlaceHints(std::vector<KeyHint> hints) {
  hints.insert(hints.end(), {{"position", kCenter},
                             {"translation", kCenter},
                             {"location", kCenter},
                             {"size", kHalfAxes},
                             {"dimensions", kHalfAxes},
                             {"extent", kHalfAxes},
                             {"scale", kHalfAxes},
                             {"yaw", kQuaternion},
                             {"rotation", kQuaternion},
                             {"orientation", kQuaternion},
                             {"quaternion", kQuaternion},
                             {"quaternion_wxyz", kQuaternion},
                             {"category", "the category is read as \"label\""},
                             {"class", "the category is read as \"label\""}});
  return hints;
}

}  // namespace

const KnownKeys& CameraKeys() {
  static const KnownKeys known = {
      {"width", "height", "fx", "fy", "cx", "cy", "distortion", "model", "camera_model",
       "distortion_model", "name", "description", "comment", "source", "fps", "depth_scale"},
      {{"k1", kCoefficients},
       {"k2", kCoefficients},
       {"k3", kCoefficients},
       {"p1", kCoefficients},
       {"p2", kCoefficients},
       {"distortion_coefficients", kCoefficients},
       {"distortion_coeffs", kCoefficients},
       {"dist_coeffs", kCoefficients},
       {"dist", kCoefficients},
       {"D", kCoefficients},
       {"k", kCoefficients},
       {"skew", "pixels are not skewed here; leave it out if it is 0"},
       {"s", "pixels are not skewed here; leave it out if it is 0"},
       {"f", "a focal length is read as \"fx\" and \"fy\""},
       {"K", kMatrix},
       {"intrinsics", kMatrix},
       {"camera_matrix", kMatrix},
       {"image_width", "the size is read as \"width\" and \"height\""},
       {"image_height", "the size is read as \"width\" and \"height\""},
       {"w", "the size is read as \"width\" and \"height\""},
       {"h", "the size is read as \"width\" and \"height\""}}};
  return known;
}

const KnownKeys& PlaneKeys() {
  static const KnownKeys known = {
      {"id", "normal", "d", "label", "name", "description", "comment"},
      {{"offset", kOffset}, {"distance", kOffset}, {"point", kOffset}, {"equation", kOffset}}};
  return known;
}

const KnownKeys& ObjectKeys() {
  static const KnownKeys known = {
      {"id", "label", "support_plane", "center", "quaternion_xyzw", "half_axes", "mirror_symmetric",
       "mirror_symmetric_yz", "rotationally_symmetric", "model", "name", "description", "comment",
       "source"},
      WithPlaceHints({{"plane", "the plane is read as \"support_plane\", an id of planes.json"},
                      {"object_id", "the id is read as \"id\""},
                      {"ignored",
                       "what is not to be judged is listed beside the objects: "
                       "{\"objects\": [...], \"ignored\": [...]}"}})};
  return known;
}

const KnownKeys& IgnoredKeys() {
  static const KnownKeys known = {{"label", "center", "quaternion_xyzw", "half_axes", "name",
                                   "description", "comment", "source"},
                                  WithPlaceHints({})};
  return known;
}

const KnownKeys& ObjectsFileKeys() {
  static const KnownKeys known = {
      {"objects", "ignored", "name", "description", "comment", "source"}};
  return known;
}

}  // namespace soslam
