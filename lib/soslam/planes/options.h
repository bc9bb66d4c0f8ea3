// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "soslam/base/options.h"
#include "soslam/initialisation/upright_options.h"

namespace soslam {

enum class PlaneSource {
  kGiven,         // given by the dataset
  kEstimated,     // from the boxes of the objects that stand on them
  kWhereMissing,  // given if there are any, otherwise estimated
  kCameraHeight,  // one ground plane per frame, at a known height below a level camera
};
inline constexpr std::array kPlaneSourceNames = {"given", "estimated", "where_missing",
                                                 "camera_height"};

// Standard deviations of how level cameras are held.
struct CameraTilt {
  double roll_sigma_deg = 5.0;
  double pitch_sigma_deg = 30.0;

  double RollSigma() const { return roll_sigma_deg * kRadPerDeg; }
  double PitchSigma() const { return pitch_sigma_deg * kRadPerDeg; }

  // `where`: what the docs begin with.
  void Describe(OptionVisitor& visit, const std::string& where = "") {
    const auto doc = [&](const char* axes) {
      return where + "standard deviation of the tilt of the cameras' " + axes + "; large: unknown";
    };
    visit.Real("camera_roll_sigma_deg", &roll_sigma_deg, {1e-3, 1e3}, doc("x axes").c_str());
    visit.Real("camera_pitch_sigma_deg", &pitch_sigma_deg, {1e-3, 1e3},
               doc("optical axes").c_str());
  }
};

// Vertical edges in images.
struct VerticalOptions {
  bool are_used = true;
  double sigma_deg = 1.0;
  double min_length_px = 30.0;

  double Sigma() const { return sigma_deg * kRadPerDeg; }

  void Describe(OptionVisitor& visit, const char* doc_of_sigma) {
    visit.Flag("verticals", &are_used,
               "look for vertical edges in the images, where there are any");
    visit.OnlyWhere({{"verticals", {"true"}}}, [&] {
      visit.Real("vertical_sigma_deg", &sigma_deg, {1e-3, 90.0}, doc_of_sigma);
      visit.Real("vertical_min_length_px", &min_length_px, {1.0, 1e5},
                 "shorter edges are not used");
    });
  }
};

struct PlanesOptions {
  PlaneSource planes = PlaneSource::kGiven;
  double camera_height_m = 1.65;
  UprightOptions upright{.axes_weight = 0.0};
  CameraTilt tilt;
  VerticalOptions verticals;
  double odometry_rotation_sigma_deg = 0.2;
  double odometry_translation_sigma_m = 0.003;
  bool refine_poses = true;
  double height_sigma_fraction = 0.05;
  double new_plane_cost = 10.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Support planes");
    visit.Choice(
        "planes", &planes, kPlaneSourceNames,
        "where the support planes come from: the dataset (given: the stage does not run); "
        "the boxes of the objects that stand on them or hang from them, with up and the planes of "
        "points that soslam-ground found (estimated); these "
        "where the sequence has no planes (where_missing); a level camera at a known height above "
        "the ground (camera_height). What the table has on "
        "walls is left out");
    visit.OnlyWhere({{"planes", {"camera_height"}}}, [&] {
      visit.Group("Ground below the camera");
      visit.Real("camera_height_m", &camera_height_m, {1e-3, 1e3},
                 "height of the camera above the ground");
    });
    visit.OnlyWhere({{"planes", {"estimated", "where_missing"}}}, [&] {
      visit.Group("Estimated planes");
      upright.DescribeSigma(visit);
      upright.DescribeViewCorrelation(
          visit,
          "boxes from viewpoints closer than this angle at the object share what the label's shape "
          "cannot explain, so that they count as one; so do the attitudes of cameras that look "
          "less than this apart; 0: all are independent");
      upright.DescribeLoss(visit,
                           "edges farther off than this many standard deviations count linearly");
      tilt.Describe(visit);
      visit.Real("height_sigma_fraction", &height_sigma_fraction, {0.0, 10.0},
                 "standard deviation of the height of an object's lowest point over its "
                 "plane, as a fraction of the object's height, for bodies that are not of their "
                 "label's shape; decides which objects share a plane");
      visit.Real("new_plane_cost", &new_plane_cost, {0.0, 1e6},
                 "cost (negative logarithm of a likelihood) of one more plane");
      visit.Flag("refine_poses", &refine_poses,
                 "finally the back end optimises planes, poses and bodies together, and its "
                 "poses carry the planes into the frames");
      visit.OnlyWhere({{"refine_poses", {"true"}}}, [&] {
        visit.Real("odometry_translation_sigma_m", &odometry_translation_sigma_m, {1e-9, 1e3},
                   "standard deviation of the odometry between two frames, per axis; where "
                   "planes are not given, it alone holds the scale");
      });
      visit.Group("Verticals (vertical edges in the images)");
      verticals.Describe(visit,
                         "standard deviation of the direction of an edge; those off by more than "
                         "three are of other edges");
      visit.Real("odometry_rotation_sigma_deg", &odometry_rotation_sigma_deg, {0.0, 90.0},
                 "standard deviation of the odometry between two frames about each "
                 "horizontal axis; its drift is taken out before planes are estimated; 0: it has "
                 "none");
    });
  }
};

}  // namespace soslam
