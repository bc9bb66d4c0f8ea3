// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/base/options.h"
#include "soslam/geometry/angles.h"

namespace soslam {

// Which parts of Detection::appearance are evidence.
struct PictureOptions {
  bool yaw = false;
  bool ratios = false;

  bool Any() const { return yaw || ratios; }
  void Describe(OptionVisitor& visit) {
    visit.Flag("picture_yaw", &yaw,
               "use what soslam-appearance says of the yaw of objects from their pictures");
    visit.Flag("picture_ratios", &ratios, "use what it says of their ratios");
  }
};

// How boxes and the axes of the scene count as evidence for an upright body, and the grid on which
// it is searched. Each stage describes those of them that it has, at their places in its own
// options; one without an option of the scene's axes gives them no weight.
struct UprightOptions {
  double detection_sigma_fraction = 0.02;
  double view_correlation_deg = 20.0;
  double huber_delta = 1.0;
  double axes_weight = 1.0;
  double yaw_grid_deg = 3.0;

  double ViewCorrelation() const { return view_correlation_deg * kRadPerDeg; }
  double YawStep() const { return yaw_grid_deg * kRadPerDeg; }

  void DescribeSigma(OptionVisitor& visit) {
    visit.Real("detection_sigma_fraction", &detection_sigma_fraction, {1e-4, 1.0},
               "standard deviation of a detector's box edge, as a fraction of the box's width or "
               "height; at least 1 px");
  }
  // The sigma of edges about the outline of the object's body, with the errors of its shape.
  void DescribeSigmaAboutBody(OptionVisitor& visit, const char* doc) {
    visit.Real("box_sigma_fraction", &detection_sigma_fraction, {1e-3, 1.0}, doc);
  }
  void DescribeViewCorrelation(
      OptionVisitor& visit,
      const char* doc =
          "boxes from viewpoints closer than this angle at the object share the "
          "error of the label's shape, and together have the weight of one; 0: all "
          "boxes are independent") {
    visit.Real("view_correlation_deg", &view_correlation_deg, {0.0, 180.0}, doc);
  }
  void DescribeLoss(OptionVisitor& visit, const char* doc) {
    visit.Real("huber_delta", &huber_delta, {1e-9, 1e9}, doc);
  }
  void DescribeAxesWeight(OptionVisitor& visit) {
    visit.Real(
        "axes_weight", &axes_weight, {0.0, 1e6},
        "cost (negative logarithm of a likelihood) of a yaw half-way between the axes of the "
        "scene, along which its straight edges lie; 0 if objects are not aligned with them");
  }
  void DescribeYawGrid(OptionVisitor& visit, const char* doc) {
    visit.Real("yaw_grid_deg", &yaw_grid_deg, {0.1, 45.0}, doc);
  }

  void Describe(OptionVisitor& visit) {
    visit.Group("Upright bodies (any shape, on a grid of yaws)");
    DescribeSigma(visit);
    DescribeAxesWeight(visit);
    DescribeYawGrid(visit, "grid of the sweep over half a turn");
  }
};

}  // namespace soslam
