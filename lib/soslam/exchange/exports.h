// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "soslam/exchange/world.h"

namespace soslam {

// Triangles over shared vertices, counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;  // metres
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// The closed surface of a landmark's body (see BodySurface) in its object frame: all vertices are
// on the surface; the 12 triangles of a box for the cuboid. Its volume is at most 1 % below the
// body's.
TriangleMesh BodyMesh(const Eigen::Vector3d& half_axes, const ShapeExponents& shape_exponents);

// Red, green and blue in sRGB, 0 to 1.
using Colour = Eigen::Vector3d;
using LabelColours = std::map<std::string, Colour>;

// A colour for each label of the worlds' objects, clearly different from its alphabetical
// neighbours'.
LabelColours ColoursOfLabels(const std::vector<World>& worlds);

// The landmarks as one mesh in the world frame, metres, in ASCII PLY: the vertices of each body are
// consecutive, in the colour of its label. `colours` must have all labels of the world.
std::string PlyText(const World& world, const LabelColours& colours);

// First category id of labels that are not COCO's; they are numbered in alphabetical order.
inline constexpr int kFirstOtherCategory = 1001;

// Expected boxes of the landmarks, in COCO's results format: for each frame and each landmark that
// is wholly in front of its camera and in the image, whether occluded or not,
//   {"image_id": the frame's id, "category_id", "bbox": [x, y, w, h] from the image's outer corner,
//    cut at its border, "score": of the object, "category_name": its label, "object_id"}.
// category_id is COCO's own if the label is one of COCO's, ignoring case and blanks.
std::string CocoResultsText(const std::vector<World>& worlds);

// The meaning of the ids in these results, in COCO's dataset format: "info", "licenses", "images",
// "categories", and as "annotations" either the same boxes (if they are ground truth for a
// comparison) or none.
enum class CocoAnnotations { kNone, kVisibleBoxes };
std::string CocoDatasetText(const std::vector<World>& worlds, CocoAnnotations annotations);

// A world in glTF 2.0, in one self-contained file. The root node "world" rotates the world so that
// EstimateCommonUp is glTF's y; below it are
// - a node "<label> <id>" per landmark: its pose, its body as a mesh in the object frame, a
// material
//   named by the label, and extras: id, label, observations, half_axes [a, b, c] in metres, yaw_deg
//   about the support normal, shape_exponent, vertical_exponent, and of ObjectEstimate the
//   covariance and the front_probability, where there are these;
// - a node "trajectory": the camera centres as a line strip, if there are at least two frames.
// `colours` must have all labels of the world.
// JSON with the numbers as a base64 data URI (.gltf):
std::string GltfText(const World& world, const LabelColours& colours);
// The binary form (.glb):
std::string GlbBytes(const World& world, const LabelColours& colours);

// A table of all objects, one row each below a header, fields quoted as in RFC 4180. Metres, and
// degrees if a column's name contains it; centre and quaternion are world_from_object. `yaw_deg` is
// about the support normal; the front is in its direction with `front_probability`. Empty are:
// standard deviations (`sigma_`) without a covariance, a front that nothing tells, all values of a
// missing landmark, and the verdict (`fate` and following) without an evaluation.
std::string LandmarksCsvText(const std::vector<World>& worlds);

// A short table of the bodies as upright boxes, one row each below a header: label; centre x, y, z;
// full lengths size_x, size_y, size_z; yaw_deg, that of size_x about EstimateCommonUp(world);
// score, the mean of the object's detections; id. Metres. size_z is along the body's axis nearest
// to up; how far that leans is left out.
std::string BoxesCsvText(const World& world);

// The poses in the text format of the TUM RGB-D benchmark: a line "timestamp tx ty tz qx qy qz qw"
// per frame, world_from_camera, below a comment that states this. Numbers round-trip exactly.
std::string TumTrajectoryText(const World& world);

// A model of COLMAP in its text format: frames that have an image, and points. Image ids are those
// of frames plus 1, names of images are relative to `images`, cameras have the lens of the image
// files, and pixels count from the outer corner of the top-left one.
struct ColmapTexts {
  std::string cameras;   // cameras.txt
  std::string images;    // images.txt
  std::string points3D;  // points3D.txt
};
// Throws InputError for the name of an image that has a blank, at which COLMAP cuts it off, and as
// ToColmap.
ColmapTexts ColmapModelTexts(const World& world, const std::filesystem::path& images);

// transforms.json of nerfstudio: frames that have an image, with the camera's axes as
// OpenGL has them (x right, y up, z backward), the lens of the image files, and pixels that count
// from the outer corner of the top-left one. Paths of images begin with `dataset`, the dataset
// folder as seen from the file. The world has an image at least. Throws InputError for a lens that
// nerfstudio does not know: of more than k1, k2, k3, p1 and p2.
std::string TransformsText(const World& world, const std::filesystem::path& dataset);

}  // namespace soslam
