// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "soslam/base/description.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/similarity.h"

namespace soslam {

// The contents of planes.json and world.json. Planes, frames and objects are named by their ids.

// Possible camera orientations: the camera axis nearest to up and the axis that is level.
enum class CameraOrientation {
  kLevel,
  kRolled90,  // clockwise about the optical axis, seen from behind the camera
  kRolled180,
  kRolled270,
  kLookingDown,
  kLookingDownRolled90,
};
inline constexpr std::array kCameraOrientations = {
    CameraOrientation::kLevel,       CameraOrientation::kRolled90,
    CameraOrientation::kRolled180,   CameraOrientation::kRolled270,
    CameraOrientation::kLookingDown, CameraOrientation::kLookingDownRolled90};
inline constexpr std::array kCameraOrientationNames = {
    "level", "rolled_90", "rolled_180", "rolled_270", "looking_down", "looking_down_rolled_90"};
inline constexpr const auto& NamesOf(CameraOrientation) { return kCameraOrientationNames; }

// Reason why an object is assigned to its plane.
enum class SupportReason {
  kOwnHeight,     // its views determine the height of its lowest point
  kLowestCost,    // its views do not: the plane on which its boxes are fitted best
  kNoViews,       // it has no views: the plane of most objects
  kCameraHeight,  // the ground below the cameras that see it
  kGiven,         // the sequence's own planes stay
  kNoBody,        // no body on any of the planes fits its boxes: the plane of most objects
  kMoving,        // it is not static: the plane of most objects
  kNone,          // no plane for its mount was found: its boxes cannot be used
};
inline constexpr std::array kSupportReasonNames = {
    "own_height", "lowest_cost", "no_views", "camera_height", "given", "no_body", "moving", "none"};
inline constexpr const auto& NamesOf(SupportReason) { return kSupportReasonNames; }

// A plane of either file.
struct PlaneRow {
  int plane = 0;
  Plane plane_in_world;
  Eigen::Vector3d point_in_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d x_axis_in_world = Eigen::Vector3d::UnitX();
  std::optional<Eigen::Matrix3d> covariance = {};
  std::optional<double> tilt_sigma_deg = {}, height_sigma_m = {};
};
template <typename Visitor>
void Describe(Visitor& visit, PlaneRow& row) {
  visit.Field("plane", &row.plane, "id, as in the sequence", kNotNegative);
  visit.Field("plane_in_world", &row.plane_in_world, "where it is");
  visit.Field("point_in_world", &row.point_in_world,
              "on the plane, in the middle of what is on it; of cameras: below them");
  visit.Field("x_axis_in_world", &row.x_axis_in_world, "unit vector in the plane");
  visit.Field("covariance", &row.covariance,
              "of rotations (rad) about the x axis and normal x x axis through the point, and of a "
              "translation (m) along the normal; null where it is not known");
  visit.Field("tilt_sigma_deg", &row.tilt_sigma_deg, "of the normal, both tilts together",
              kNotNegative);
  visit.Field("height_sigma_m", &row.height_sigma_m, "of the plane at its point", kNotNegative);
}

// One tried way to hold the cameras and its result.
struct TriedOrientation {
  CameraOrientation orientation = CameraOrientation::kLevel;
  bool verticals = false;
  double cost = 0.0;
  double probability = 0.0;
  std::optional<int> planes = {};  // none where it was given up before planes were looked for
};

struct PlanesReport {
  struct Error {
    int plane = 0;
    double angle_deg = 0.0;
    double offset_m = 0.0;
  };
  struct EstimatedPlaneRow {
    PlaneRow plane;
    std::optional<Error> error = {};
  };
  struct ObjectRow {
    int object = 0;
    std::string label;
    std::optional<int> plane = {};
    SupportReason reason = SupportReason::kNoViews;
    std::optional<double> height_m = {}, height_sigma_m = {}, cost = {};
  };
  struct OrientationRow {
    CameraOrientation held = CameraOrientation::kLevel;
    bool verticals = false;
    bool is_clear = false;
    std::vector<TriedOrientation> tried = {};
  };
  std::string dataset;
  std::vector<EstimatedPlaneRow> planes = {};
  std::vector<ObjectRow> objects = {};
  Eigen::Vector3d up_of_cameras_in_world = Eigen::Vector3d::UnitZ();
  std::optional<OrientationRow> camera_holding = {};
  std::optional<double> cost = {};
  int rounds = 0;
  bool settled = false;
};
template <typename Visitor>
void Describe(Visitor& visit, PlanesReport::Error& error) {
  visit.Field("plane", &error.plane, "id of the given plane");
  visit.Field("angle_deg", &error.angle_deg, "between the normals", kNotNegative);
  visit.Field("offset_m", &error.offset_m, "of the point over the given plane");
}
template <typename Visitor>
void Describe(Visitor& visit, PlanesReport::EstimatedPlaneRow& row) {
  Describe(visit, row.plane);
  visit.Field("error", &row.error,
              "against the given plane of most objects on it, for evaluation; null where no object "
              "stands on it");
}
template <typename Visitor>
void Describe(Visitor& visit, PlanesReport::ObjectRow& row) {
  visit.Field("object", &row.object, "id of the object");
  visit.Field("label", &row.label, "category");
  visit.Field("plane", &row.plane, "id of the plane that it is mounted on; null for reason none",
              kNotNegative);
  visit.Field(
      "reason", &row.reason,
      "own_height: its views determine the height of its lowest point, and this is the "
      "plane at that height; lowest_cost: they do not, and its boxes fit this plane best; "
      "no_views, no_body, moving: it has no boxes, or no body fits them on any plane, or it "
      "moves, and this is the plane of most objects; camera_height: the ground below the "
      "cameras that see it; given: the sequence's own planes stay; none: no plane for its "
      "mount was found, and its boxes are left out");
  visit.Field("height_m", &row.height_m,
              "of its lowest point over its plane, by its own views alone");
  visit.Field("height_sigma_m", &row.height_sigma_m, "standard deviation of that", kNotNegative);
  visit.Field("cost", &row.cost,
              "negative log likelihood of its boxes and ratio, on its plane; null without a body");
}
template <typename Visitor>
void Describe(Visitor& visit, TriedOrientation& row) {
  visit.Field("held", &row.orientation, "how the cameras are held");
  visit.Field("verticals", &row.verticals, "vertical edges of the images are used");
  visit.Field("cost", &row.cost,
              "over that of the one taken, as a negative log likelihood; negative of one for which "
              "no planes were found and that would be more probable");
  visit.Field("probability", &row.probability,
              "0 of one that was given up for what upright bodies cost, and of one that leads to "
              "the same up as another",
              kShare);
  visit.Field("planes", &row.planes, "number; null where none were looked for or found",
              kAtLeastOne);
}
template <typename Visitor>
void Describe(Visitor& visit, PlanesReport::OrientationRow& row) {
  visit.Field("held", &row.held,
              "rolled: turned clockwise about the optical axis, seen from behind the camera; "
              "looking_down: by more than 45 degrees");
  visit.Field("verticals", &row.verticals,
              "vertical edges of the images are used; false also where boxes contradict them");
  visit.Field("is_clear", &row.is_clear,
              "all other ways together have a probability below 0.01; else tilt_sigma_deg, but not "
              "covariance, includes what they would make of the normal");
  visit.Field("tried", &row.tried, "those that lead to different up directions",
              {.least_items = 1});
}
template <typename Visitor>
void Describe(Visitor& visit, PlanesReport& report) {
  visit.Field("dataset", &report.dataset, "name of the dataset");
  visit.Field("planes", &report.planes, "as in the sequence written beside", {.least_items = 1});
  visit.Field("objects", &report.objects, "one row per object of the sequence");
  visit.Field(
      "up_of_cameras_in_world", &report.up_of_cameras_in_world,
      "where the search for up began: as cameras are held and vertical edges say, or points");
  visit.OrAbsent("camera_holding", &report.camera_holding, "where planes are estimated");
  visit.Field(
      "cost", &report.cost,
      "negative log likelihood of all boxes, ratios and the up prior; null with planes from "
      "the camera's height");
  visit.Field("rounds", &report.rounds, "how often objects were assigned to planes", kNotNegative);
  visit.Field("settled", &report.settled, "the last round changed nothing");
}

// A map whose scale (a factor) or up is off by more is no use.
inline constexpr double kTrustedScale = 1.5;
inline constexpr double kTrustedUpDeg = 10.0;

// The scale of a world, and what it rests on.
struct WorldScale {
  double metres_per_unit = 1.0;                   // of the input's world, median
  double log_sigma = 0.0;                         // standard deviation of its logarithm
  double low = 1.0, high = 1.0;                   // interval of 95 %
  double probability = 1.0;                       // that it is within a factor of kTrustedScale
  std::vector<std::string> found_by = {};         // "objects", and the settings that give it
  int objects = 0;                                // those whose heights agree with it
  std::vector<std::string> contradicted_by = {};  // checks whose findings contradict it
  double independent_objects = 0.0;
  std::vector<std::string> labels = {};  // sorted
  double misfit = 1.0;
  double other_scales_probability = 0.0;
};
template <typename Visitor>
void Describe(Visitor& visit, WorldScale& scale) {
  visit.Field("metres_per_unit", &scale.metres_per_unit, "of the input's world, median", kPositive);
  visit.Field("log_sigma", &scale.log_sigma, "standard deviation of its logarithm", kNotNegative);
  std::array<double, 2> interval = {scale.low, scale.high};
  visit.Field("interval_95", &interval, "has the true one with a probability of 95 %", kPositive);
  visit.AfterReading([&] { scale.low = interval[0], scale.high = interval[1]; });
  visit.Field("probability", &scale.probability, "that it is right to a factor of 1.5", kShare);
  visit.Field("found_by", &scale.found_by,
              "what it rests on: heights of objects, the settings scale and camera_height_m, edits "
              "that give sizes of objects");
  visit.Field("objects", &scale.objects, "whose height agrees with it", kNotNegative);
  visit.OrDefault(
      "contradicted_by", &scale.contradicted_by, {},
      "checks whose findings contradict the scale, which may then be wrong by more than "
      "its interval says: scale_of_objects_differs (heights of objects contradict the "
      "settings), scale_contradicted (they contradict one another), "
      "settings_of_scale_differ (scale and camera_height_m contradict each other)");
  visit.Field("independent_objects", &scale.independent_objects,
              "the same, where objects of one label count for less", kNotNegative);
  visit.Field("labels", &scale.labels, "of these objects");
  visit.Field("misfit", &scale.misfit,
              "factor on the spread because the objects contradict one another more than their "
              "standard deviations allow",
              kAtLeastOne);
  visit.Field("other_scales_probability", &scale.other_scales_probability,
              "of another group of scales, where objects contradict one another", kShare);
}

template <typename Visitor>
void Describe(Visitor& visit, Similarity& change) {
  visit.Field("scale", &change.scale, "rotation * (scale * point) + translation", kPositive);
  Describe(visit, change.rigid);
}

struct WorldReport {
  struct TriedRow {
    CameraOrientation held = CameraOrientation::kLevel;
    double cost = 0.0;
    double probability = 0.0;
  };
  struct Up {
    Eigen::Vector3d up_in_input = Eigen::Vector3d::UnitZ();
    double sigma_deg = 0.0;
    std::string found_by;
    std::string cameras_held;
    bool verticals = false;
    double sigma_of_cameras_deg = 0.0;
    double angle_to_cameras_deg = 0.0;
    std::vector<TriedRow> tried = {};
    double probability = 1.0;
  };
  struct SupportRow {
    PlaneRow plane;
    int points = 0;
    int objects = 0;
  };
  struct ObjectRow {
    std::string label;
    int boxes = 0;
    std::optional<int> plane = {};
    std::optional<Eigen::Vector3d> centre_in_world = {};
    std::optional<double> height_m = {}, log_scale = {}, log_sigma = {};
    double weight = 0.0;
    double agreement = 0.0;
    bool is_measured = false;
    std::optional<double> pull = {};

    bool AgreesWithScale() const { return agreement >= 0.5; }
    bool TellsByLabel() const { return AgreesWithScale() && !is_measured; }
  };
  std::string dataset;
  Up up;
  std::optional<WorldScale> scale = {};
  Similarity output_from_input;
  std::vector<SupportRow> planes = {};
  int points = 0;
  int planes_of_points = 0;
  std::vector<ObjectRow> objects = {};
};
template <typename Visitor>
void Describe(Visitor& visit, WorldReport::TriedRow& row) {
  visit.Field("held", &row.held, "how the cameras are held");
  visit.Field("cost", &row.cost,
              "negative log likelihood over that of the one taken, of the prior, boxes, turned "
              "images and objects on planes");
  visit.Field("probability", &row.probability, "among all that were tried", kShare);
}
template <typename Visitor>
void Describe(Visitor& visit, WorldReport::Up& up) {
  visit.Field("up_in_input", &up.up_in_input, "unit vector in the input's world");
  visit.Field("sigma_deg", &up.sigma_deg, "standard deviation, both tilts together", kNotNegative);
  visit.Field("found_by", &up.found_by,
              "planes: horizontal planes of points with objects on them; cameras: the way that "
              "cameras are held");
  visit.Check([&] { return NotOneOf("found_by", up.found_by, {"planes", "cameras"}); });
  visit.Field("cameras_held", &up.cameras_held,
              "as held in planes.json; turned: in many ways, so that only planes tell up");
  visit.Check([&] {
    std::vector<std::string> known(kCameraOrientationNames.begin(), kCameraOrientationNames.end());
    known.push_back("turned");
    return NotOneOf("cameras_held", up.cameras_held, known);
  });
  visit.Field("verticals", &up.verticals,
              "vertical edges in the images were used; false also where points contradict them");
  visit.Field("sigma_of_cameras_deg", &up.sigma_of_cameras_deg, "of up without the points",
              kNotNegative);
  visit.Field("angle_to_cameras_deg", &up.angle_to_cameras_deg,
              "between up without the points and up", kNotNegative);
  visit.OrDefault("tried", &up.tried, {},
                  "ways to hold the cameras, but for those that are 10000 times less probable "
                  "before planes are looked for; without turned, which is tried where fewer than "
                  "half of the objects stand on planes");
  visit.Field("probability", &up.probability, "that it is right to 10 degrees", kShare);
}
template <typename Visitor>
void Describe(Visitor& visit, WorldReport::SupportRow& row) {
  Describe(visit, row.plane);
  visit.Field("points", &row.points, "sparse points on it", kNotNegative);
  visit.Field("objects", &row.objects, "that most probably stand on it", kNotNegative);
}
template <typename Visitor>
void Describe(Visitor& visit, WorldReport::ObjectRow& row) {
  constexpr Limits kShareAfterRounding = {0.0, 1.0001};
  visit.Field("label", &row.label, "the most probable one");
  visit.Field("boxes", &row.boxes, "number", kAtLeastOne);
  visit.Field("plane", &row.plane, "id of the plane that it most probably stands on; null: none");
  visit.Field("centre_in_world", &row.centre_in_world,
              "in the output's world; null where no body fits the boxes");
  visit.Field("height_m", &row.height_m, "by its boxes, in the output's world");
  visit.Field("log_scale", &row.log_scale,
              "logarithm of metres per unit of the input, by the height of its label, or the size "
              "that edits give");
  visit.Field("log_sigma", &row.log_sigma, "standard deviation of that");
  visit.Field("weight", &row.weight, "below 1 where other objects have the same label", kShare);
  visit.Field("agreement", &row.agreement, "probability that its height is right",
              kShareAfterRounding);
  visit.OrDefault("is_measured", &row.is_measured, false,
                  "edits give a size, which tells the scale in place of the height of the label");
  visit.OrAbsent("pull", &row.pull,
                 "by how much it raises the logarithm of the scale; absent where nothing else "
                 "tells the scale");
}

template <typename Visitor>
void Describe(Visitor& visit, WorldReport& world) {
  visit.Field("dataset", &world.dataset, "name of the dataset");
  visit.Field("up", &world.up, "z of the output's world");
  visit.Field("scale", &world.scale, "null where nothing tells it: the unit is that of the input");
  visit.Field("output_from_input", &world.output_from_input, "to the output's world");
  visit.Field("planes", &world.planes, "support planes, in the output's world");
  visit.Field("points", &world.points, "sparse points that were used", kNotNegative);
  visit.Field("planes_of_points", &world.planes_of_points,
              "horizontal planes in the points, before those without an object were dropped",
              kNotNegative);
  visit.Field("objects", &world.objects, "groups of boxes at one place");
}

}  // namespace soslam
