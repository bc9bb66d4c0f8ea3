// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>

#include "soslam/association/options.h"
#include "soslam/base/options.h"

namespace soslam {

enum class GroundSource {
  kGiven,      // the dataset's world is upright and has its scale
  kEstimated,  // it has neither, as that of structure from motion
};
inline constexpr std::array kGroundSourceNames = {"given", "estimated"};

struct GroundOptions {
  GroundSource ground = GroundSource::kGiven;
  double scale = 0.0;
  double scale_log_sigma = 0.02;
  double camera_height_m = 0.0;
  double camera_height_log_sigma = 0.1;
  double wrong_height_probability = 0.05;
  double same_label_correlation = 0.3;
  int min_boxes = 3;
  bool shared_points = false;
  UprightOptions upright = kUprightTracks;
  CameraTilt tilt;
  VerticalOptions verticals;

  void Describe(OptionVisitor& visit) {
    visit.Group("Ground");
    visit.Choice(
        "ground", &ground, kGroundSourceNames,
        "whether up and scale are those of the dataset, or this stage finds them out, with "
        "planes of points; the stage runs only in the latter case");
    visit.Group("Scale");
    visit.Real("scale", &scale, {0.0, 1e9},
               "metres per unit of the input's world, where it is known; 0: unknown. It is "
               "combined with the heights of objects");
    visit.Real("scale_log_sigma", &scale_log_sigma, {0.005, 10.0},
               "standard deviation of the logarithm of `scale`; 0.02 is 2 %");
    visit.Real("camera_height_m", &camera_height_m, {0.0, 1e3},
               "median height of the cameras above the lowest horizontal plane of points, where it "
               "is known; 0: unknown. It is combined with the heights of objects");
    visit.Real("camera_height_log_sigma", &camera_height_log_sigma, {0.005, 10.0},
               "standard deviation of the logarithm of `camera_height_m`");
    visit.Real("wrong_height_probability", &wrong_height_probability, {1e-6, 0.5},
               "the share of objects whose height says nothing on the scale, because of a wrong "
               "label or box");
    visit.Real("same_label_correlation", &same_label_correlation, {0.0, 1.0},
               "correlation of the heights of objects of one label beyond that of the table: "
               "chairs in one room are often of one model; 1: together they count as one object");
    visit.Group("Objects");
    visit.Integer("min_boxes", &min_boxes, {2, 100000}, "objects with fewer boxes are not used");
    visit.Flag("shared_points", &shared_points,
               "points that several images show (soslam-match) tell which boxes show the same "
               "object; needs images");
    upright.DescribeSigmaAboutBody(
        visit,
        "standard deviation of a box edge about that of the object's body, as a fraction of the "
        "box's width or height, at least 1 px");
    upright.DescribeViewCorrelation(
        visit,
        "boxes from viewpoints closer than this angle at the object count as one; so do the tilts "
        "of cameras that look less than this apart");
    visit.Group("Up");
    tilt.Describe(visit);
    verticals.Describe(visit,
                       "standard deviation of the direction of a vertical edge; those off by more "
                       "than three are of other edges");
  }
};

}  // namespace soslam
