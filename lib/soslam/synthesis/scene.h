// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/synthesis/body.h"

namespace soslam {

// The top of a table: a rectangular slab under its plane, with four legs. It is rendered and
// occludes, but is not an object of the scene.
struct TableTop {
  Eigen::Vector2d position_on_plane = Eigen::Vector2d::Zero();  // of the slab's middle, metres
  Eigen::Vector2d half_size = Eigen::Vector2d::Ones();          // metres
  double yaw = 0.0;
  double thickness = 0.04;  // metres
  double leg_length = 0.0;  // metres, below the slab; 0: no legs
};

// A support plane. Without a table it is an infinite floor. Its own frame: origin at the point
// nearest to the world's origin, z the normal, x the direction of yaw 0; for a level plane in a
// world with z up these are the world's x and y axes.
struct ScenePlane {
  int id = 0;
  std::string label;
  Plane plane_in_world;
  std::optional<TableTop> table;
};

// A textured solid on a plane.
struct SceneObject {
  int id = 0;
  std::string label;
  Shape shape = Shape::kEllipsoid;
  Eigen::Vector3d half_axes = Eigen::Vector3d::Ones();          // along its own axes, metres
  Eigen::Vector2d position_on_plane = Eigen::Vector2d::Zero();  // metres, in the plane's frame
  double yaw = 0.0;                                             // about the plane's normal
  int plane_index = 0;                                          // into Scene::planes
  int texture_seed = 0;
  RestingFace rests_on = RestingFace::kBottom;
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  // rotation vector about x and y of its frame
  // Frames in which it is there, the last one not included. A thing that is moved is an object at
  // each of its places.
  int from_frame = 0;
  std::optional<int> until_frame = std::nullopt;
};

// Position of the camera, and the point in the middle of its image.
struct Waypoint {
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d look_at_in_world = Eigen::Vector3d::UnitX();
};

// `frames` poses on a smooth curve through the waypoints, the first and the last pose at the first
// and the last waypoint.
struct Trajectory {
  std::vector<Waypoint> waypoints;
  int frames = 1;
  double frame_interval = 0.1;  // seconds
};

// Noise of the simulated measurements. All zero: none.
struct SceneNoise {
  double box_edge_sigma = 0.0;    // of each box edge, as a fraction of the box's width or height
  double box_sigma_px = 0.0;      // of each box edge, in addition, pixels
  double miss_probability = 0.0;  // probability that a detection is missing
  double odometry_translation_sigma = 0.0;   // random walk on each axis, metres per sqrt(metre)
  double odometry_scale_sigma = 0.0;         // one scale error for the whole trajectory
  double odometry_rotation_sigma_deg = 0.0;  // random walk, degrees per sqrt(metre + turn / 30 deg)
  double image_sigma = 0.0;                  // grey levels, per pixel and channel
  double false_share = 0.0;  // expected number of boxes of nothing for each detection
};

// The subjects of the detector's boxes: whole objects, each wholly inside the image with its centre
// in sight; or the visible parts of objects, also of those that are cut or partly hidden.
enum class BoxedPart { kWhole, kVisible };
inline constexpr std::array kBoxedPartNames = {"whole", "visible"};  // in files
inline constexpr const auto& NamesOf(BoxedPart) { return kBoxedPartNames; }

// All data that define a synthetic sequence. The normal of planes[0] is the camera's up direction.
// Objects and planes are sorted by id.
struct Scene {
  std::string name;
  Camera camera;
  std::vector<ScenePlane> planes;
  std::vector<Plane> walls_in_world;  // drawn only; the normal points into the room
  std::vector<SceneObject> objects;
  Trajectory trajectory;
  SceneNoise noise;
  int seed = 0;  // of all noise
  BoxedPart boxes = BoxedPart::kWhole;
  double min_visible_share = 0.3;  // of an object's silhouette, for boxes of visible parts
};

// Descriptions of scene files, see base/description.h. Angles are in degrees there.

// Fields with these names: a plane normal . x + d = 0.
template <typename Visitor>
void DescribePlane(Visitor& visit, Plane& plane) {
  visit.Unit("normal", &plane.normal, "unit normal");
  visit.Field("d", &plane.offset, "normal . x + d = 0, metres");
  visit.AfterReading([&] { plane.normal.normalize(); });
}

// An angle (rad) as a field in degrees, zero if absent.
template <typename Visitor>
void DescribeAngle(Visitor& visit, const char* name, double* angle, const char* doc) {
  double deg = kDegPerRad * *angle;
  visit.OrDefault(name, &deg, 0.0, doc);
  visit.AfterReading([&] { *angle = kRadPerDeg * deg; });
}

template <typename Visitor>
void Describe(Visitor& visit, TableTop& table) {
  visit.Field("position", &table.position_on_plane, "of the middle, metres in the plane's frame");
  visit.Field("half_size", &table.half_size, "metres", kPositive);
  DescribeAngle(visit, "yaw_deg", &table.yaw, "about the plane's normal");
  visit.OrDefault("thickness", &table.thickness, TableTop().thickness, "metres", kPositive);
  visit.OrDefault("leg_length", &table.leg_length, 0.0, "metres, 0: no legs", kNotNegative);
}

template <typename Visitor>
void Describe(Visitor& visit, ScenePlane& plane) {
  visit.Field("id", &plane.id, "id", kNotNegative);
  visit.Field("label", &plane.label, "category", kNotEmpty);
  DescribePlane(visit, plane.plane_in_world);
  visit.OrAbsent("table", &plane.table, "slab under the plane; absent: a floor without end");
}

template <typename Visitor>
void Describe(Visitor& visit, SceneObject& object) {
  visit.Field("id", &object.id, "id", kNotNegative);
  visit.Field("label", &object.label, "category", kNotEmpty);
  visit.Check([&] {
    return object.label.find_first_of(",\"\n\r") == std::string::npos
               ? std::string()
               : "label has a comma, quote or line break; expected none";
  });
  visit.Field("shape", &object.shape, "box, ellipsoid or upright cylinder");
  visit.Field("half_axes", &object.half_axes,
              "along its own x (front), y and z (up as it stands), metres", kPositive);
  visit.Field("plane", &object.plane_index, "id of the plane that it stands on", kNotNegative);
  visit.Field("position", &object.position_on_plane, "metres in the plane's frame");
  DescribeAngle(visit, "yaw_deg", &object.yaw, "about the plane's normal");
  visit.OrAbsent("rests_on", &object.rests_on,
                 "face on the plane: on its back, its own front points up; on its side, its own "
                 "left");
  Eigen::Vector2d tilt_deg = kDegPerRad * object.tilt;
  visit.OrDefault(
      "tilt_deg", &tilt_deg, Eigen::Vector2d(0.0, 0.0),
      "how it leans: rotation vector about x and y of the frame that yaw turns, whose z "
      "is the plane's normal; its lowest point is on the plane");
  visit.AfterReading([&] { object.tilt = tilt_deg * kRadPerDeg; });
  visit.OrDefault("from_frame", &object.from_frame, 0, "before this frame it is not there",
                  kNotNegative);
  visit.OrAbsent("until_frame", &object.until_frame, "from this frame on it is not there",
                 kNotNegative);
  visit.OrDefault("texture_seed", &object.texture_seed, object.id, "the id if absent",
                  kNotNegative);
}

template <typename Visitor>
void Describe(Visitor& visit, Waypoint& waypoint) {
  visit.Field("position", &waypoint.position_in_world, "metres");
  visit.Field("look_at", &waypoint.look_at_in_world, "metres");
}

template <typename Visitor>
void Describe(Visitor& visit, Trajectory& trajectory) {
  visit.Field("frames", &trajectory.frames, "number", {1.0, 1e5});
  visit.Field("frame_interval", &trajectory.frame_interval, "seconds", kPositive);
  visit.Field("waypoints", &trajectory.waypoints, "on the path", {.least_items = 1});
}

template <typename Visitor>
void Describe(Visitor& visit, SceneNoise& noise) {
  visit.OrDefault("box_edge_sigma", &noise.box_edge_sigma, 0.0,
                  "of each box edge, as a fraction of the box's width or height", {0.0, 0.5});
  visit.OrDefault("box_sigma_px", &noise.box_sigma_px, 0.0, "of each box edge, in addition",
                  kNotNegative);
  visit.OrDefault("miss_probability", &noise.miss_probability, 0.0, "of a detection", kShare);
  visit.OrDefault("odometry_translation_sigma", &noise.odometry_translation_sigma, 0.0,
                  "random walk on each axis, metres per square root of a metre", kNotNegative);
  visit.OrDefault("odometry_scale_sigma", &noise.odometry_scale_sigma, 0.0,
                  "of one scale error for the whole trajectory", {0.0, 0.3});
  visit.OrDefault("odometry_rotation_sigma_deg", &noise.odometry_rotation_sigma_deg, 0.0,
                  "random walk, degrees per square root of (metres + turn / 30 degrees)",
                  kNotNegative);
  visit.OrDefault("image_sigma", &noise.image_sigma, 0.0, "grey levels", {0.0, 255.0});
  visit.OrDefault("false_share", &noise.false_share, 0.0,
                  "expected number of boxes of nothing for each detection", kShare);
}

template <typename Visitor>
void Describe(Visitor& visit, Scene& scene) {
  visit.Field("name", &scene.name, "name of the dataset", kNotEmpty);
  visit.Field("camera", &scene.camera, "pinhole camera; x right, y down, z forward");
  visit.Field("planes", &scene.planes,
              "support planes; the normal of the one with the lowest id is up for the camera",
              {.least_items = 1});
  visit.OrAbsent("walls", &scene.walls_in_world,
                 "planes that are drawn only; the normal points into the room", {},
                 [](auto& visit, Plane& plane) { DescribePlane(visit, plane); });
  visit.Field("objects", &scene.objects, "textured solids", {.least_items = 1});
  visit.Field("trajectory", &scene.trajectory, "of the camera");
  visit.OrDefault("noise", &scene.noise, SceneNoise(), "of measurements");
  visit.OrDefault("seed", &scene.seed, 0, "of all noise", kNotNegative);
  visit.OrDefault("boxes", &scene.boxes, Scene().boxes,
                  "what detections are around: whole objects, wholly inside the image with their "
                  "centre in sight, or visible parts of objects");
  visit.OrDefault("min_visible_share", &scene.min_visible_share, Scene().min_visible_share,
                  "of the silhouette of an object, inside and outside the image, that has to be "
                  "visible for a box of the visible part",
                  kShare);
}

// The scene with those of its objects that are there in a frame.
Scene SceneAt(Scene scene, int frame_index);

// Transformation from a plane's own frame to the world, see ScenePlane.
Rigid3d WorldFromPlane(const Plane& plane_in_world);

// The object's landmark in the world: tangent to its plane, its z axis along the plane's normal but
// for the tilt.
Landmark ObjectLandmark(const Scene& scene, const SceneObject& object);

// The object's solid in the world, in its own axes.
Landmark ObjectBody(const Scene& scene, const SceneObject& object);

// All solids in the world: those of the objects, in their order, then slabs and legs of the tables.
std::vector<Landmark> AllBodies(const Scene& scene);

// The true pose of each frame. Throws InputError when the camera looks straight up or down, or at
// its own position, which leaves its roll undefined.
std::vector<Rigid3d> TruePoses(const Scene& scene);

// The scene in a JSON document. Throws InputError, naming `where`
// and the field, when it is not valid or not possible: a duplicate id, an unknown plane, a normal
// that is not of unit length, the camera inside an object, behind a plane or looking straight up or
// down.
Scene ParseScene(const nlohmann::json& document, const std::string& where);

// The scene in a file; throws InputError as above, and when there is no such file.
Scene ReadScene(const std::filesystem::path& path);

}  // namespace soslam
