// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "soslam/geometry/landmark.h"

namespace soslam {

// Horizontal unit vectors of a plan in the world: to the right, and away from its reader.
struct PlanAxes {
  Eigen::Vector3d right;
  Eigen::Vector3d away;

  Eigen::Vector2d Place(const Eigen::Vector3d& point_in_world) const {
    return {right.dot(point_in_world), away.dot(point_in_world)};
  }
};

// The axes with which the scene axis (or else an axis of the world) is horizontal, the plan wider
// than high, and the cameras nearer to the reader than the objects.
PlanAxes AxesOfPlan(const Eigen::Vector3d& up, const std::optional<Eigen::Vector3d>& scene_axis,
                    const std::vector<Eigen::Vector3d>& objects,
                    const std::vector<Eigen::Vector3d>& cameras);

// The outline of a body from above; of a cuboid its corners, of round ones up to 72 points.
std::vector<Eigen::Vector2d> Footprint(const Landmark& landmark_in_world, const PlanAxes& axes);

// A triangle within the outline that points to the front, the x axis of a body.
std::vector<Eigen::Vector2d> Front(const Landmark& landmark_in_world, const PlanAxes& axes);

// The largest of ..., 0.1, 0.2, 0.5, 1, 2, 5, ... that is no larger.
double RoundLength(double length);

// "50 cm", "2 m"; a bare number where the world has no unit.
std::string LengthInWords(double length, bool in_metres);

// An object on a plan; lengths in the unit of the world.
struct PlanObject {
  std::string name;
  std::vector<Eigen::Vector2d> footprint;
  double top = 0.0;  // its height
  // The id of an SVG element with the picture, empty without one, and its width by its height.
  std::string picture = {};
  double picture_aspect = 1.0;
  bool is_uncertain = false;
  std::vector<Eigen::Vector2d> front = {};  // the corners of Front where it is known
};

struct PlanView {
  std::vector<PlanObject> objects;       // the lowest first, as later ones are drawn above
  std::vector<Eigen::Vector2d> cameras;  // in the order of their frames
  bool in_metres = true;
};

// Place for a plan on the screen, px; pictures and text have this size at `width`.
struct PlanFormat {
  const char* name;  // class of the SVG element
  double width;
  double max_height;
  double margin;  // around objects and cameras, for names
  double font;
  std::vector<double> picture_heights;  // tried in turn, until names and pictures do not overlap
};
inline const PlanFormat kWidePlan = {"for-wide", 1148.0, 640.0,
                                     84.0,       13.0,   {84.0, 64.0, 48.0, 36.0, 0.0}};
inline const PlanFormat kNarrowPlan = {"for-narrow", 358.0, 420.0,
                                       34.0,         11.0,  {44.0, 34.0, 26.0, 0.0}};

// The plan as an SVG element: a grid with a scale bar, the cameras' path, the objects with their
// names and pictures.
std::string PlanSvg(const PlanView& plan, const PlanFormat& format);

}  // namespace soslam
