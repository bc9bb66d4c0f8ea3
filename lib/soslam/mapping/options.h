// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "soslam/base/options.h"
#include "soslam/constraints/image_options.h"
#include "soslam/constraints/object_point.h"
#include "soslam/constraints/odometry_noise.h"
#include "soslam/constraints/variances.h"
#include "soslam/initialisation/upright_options.h"
#include "soslam/model/semantic_table.h"

namespace soslam {

enum class DetectionModel {
  kQuadric,   // eq. (2)-(4), and the ratio constraint of eq. (9)-(11): ellipsoids
  kTangency,  // bodies of any shape, in pixels; ratios with their label's spread
};
inline constexpr std::array kDetectionModelNames = {"quadric", "tangency"};

// Whether and how images and points are evidence (symmetry, edge_alignment and what belongs to
// them, pictures, points.point_evidence) is for those who make BackEndInput, as the stage
// "optimise".
struct OptimiseOptions {
  DetectionModel detection_model = DetectionModel::kQuadric;
  bool hold_poses = false;
  bool support = true;
  bool ratio = true;
  bool symmetry = false;
  bool edge_alignment = false;
  RatioPrior ratio_prior = RatioPrior::kTable;
  ShapeSource shape = ShapeSource::kTable;
  // The paper's numbers read in metres, unlike in one frame: with dozens of boxes to a landmark,
  // what an ellipsoid cannot fit in them would outvote the one support and the one ratio
  // constraint.
  ConstraintVariances variances{.detection_dm4 = 1e5, .support_tangency_dm4 = 1e5};
  double odometry_rotation_sigma_deg = 0.2;
  double odometry_rotation_fraction = 0.0;
  double odometry_translation_sigma_m = 0.01;
  double symmetry_sigma = 30.0;
  int symmetry_views = 1;
  double detector_bias_sigma_px = 0.0;
  UprightOptions upright;
  double standing_angle_sigma_deg = 0.1;
  double standing_height_sigma_m = 0.002;
  bool refine_planes = true;
  EdgeOptions edges;
  TextureOptions texture;
  PointOptions points;
  PictureOptions pictures;
  SymmetryOptions symmetry_options;
  bool covariances = true;
  bool check_inputs = true;
  int max_iterations = 500;

  OdometryNoise Odometry() const {
    return {odometry_rotation_sigma_deg * kRadPerDeg, odometry_translation_sigma_m,
            odometry_rotation_fraction};
  }

  void Describe(OptionVisitor& visit) {
    visit.Group("Constraints");
    visit.Choice("detection_model", &detection_model, kDetectionModelNames,
                 "residual of a box: the tangent planes of the ellipsoid, eq. (4) (quadric), or "
                 "the distance in pixels between its edges and the outline of a body of the "
                 "label's shape, with the label's spread of ratios (tangency)");
    visit.Flag("support", &support, "use the support constraint, eq. (5)-(8)");
    visit.Flag("ratio", &ratio, "use the scale ratio constraint, eq. (9)-(11)");
    DescribeRatioPrior(visit, &ratio_prior);
    visit.Flag("symmetry", &symmetry,
               "use the texture symmetry of some of each object's observations, eq. (16)");
    visit.Flag("edge_alignment", &edge_alignment,
               "use the alignment of the bodies' edges with the images'");
    visit.OnlyWhere({{"symmetry", {"true"}}}, [&] {
      visit.Integer("symmetry_views", &symmetry_views, {1, 100000},
                    "how many observations of each object, evenly over all from the first on");
    });
    upright.DescribeLoss(visit,
                         "weighted residuals beyond this count linearly (Huber loss H of eq. (1)); "
                         "with tangency, those of odometry and boxes");
    visit.Group("Poses and odometry");
    visit.Flag("hold_poses", &hold_poses,
               "the poses of the trajectory are constant, as those of motion capture or structure "
               "from motion should be; otherwise they are odometry, which drifts");
    visit.OnlyWhere({{"hold_poses", {"false"}}}, [&] {
      visit.Real("odometry_rotation_sigma_deg", &odometry_rotation_sigma_deg, {1e-9, 1e9},
                 "standard deviation of the odometry between two frames");
      visit.Real("odometry_rotation_fraction", &odometry_rotation_fraction, {0.0, 1.0},
                 "the same, but at most this fraction of the rotation, and at least a fortieth of "
                 "odometry_rotation_sigma_deg: odometry of a camera that turns little errs little; "
                 "0: the same for every rotation");
      visit.Real("odometry_translation_sigma_m", &odometry_translation_sigma_m, {1e-9, 1e9},
                 "standard deviation of the odometry between two frames, per axis");
    });
    visit.OnlyWhere({{"detection_model", {"tangency"}}}, [&] {
      visit.Group("Bodies of any shape");
      DescribeShape(visit, &shape);
      upright.DescribeSigma(visit);
      visit.Real("detector_bias_sigma_px", &detector_bias_sigma_px, {0.0, 1e4},
                 "standard deviation of a bias that each of the four edges has in all boxes "
                 "of the sequence, estimated along; 0: no bias");
      upright.DescribeViewCorrelation(visit);
      upright.DescribeAxesWeight(visit);
      visit.Real("standing_angle_sigma_deg", &standing_angle_sigma_deg, {1e-6, 90.0},
                 "standard deviation of the tilt of a body on its support plane; not of those that "
                 "may lean");
      visit.Real("standing_height_sigma_m", &standing_height_sigma_m, {1e-6, 1e3},
                 "standard deviation of the height of a body's foot over its support plane");
      visit.Flag("refine_planes", &refine_planes,
                 "estimated support planes are variables; given ones never are");
    });
    visit.OnlyWhere({{"detection_model", {"quadric"}}}, [&] { variances.Describe(visit); });
    visit.OnlyWhere({{"symmetry", {"true"}}}, [&] {
      symmetry_options.Describe(visit);  // the next one comes under its heading
      visit.OnlyWhere({{"detection_model", {"quadric"}}}, [&] {
        visit.Real(
            "symmetry_sigma", &symmetry_sigma, {1e-9, 1e9},
            "standard deviation of a pair's descriptor difference, in the descriptor's unit");
      });
    });
    visit.OnlyWhere({{"edge_alignment", {"true"}}}, [&] { edges.Describe(visit); });
    visit.OnlyWhere({{"symmetry", {"true"}}}, [&] {
      visit.OnlyWhere({{"detection_model", {"tangency"}}}, [&] { texture.Describe(visit); });
    });
    points.Describe(visit);
    visit.OnlyWhere({{"detection_model", {"tangency"}}}, [&] { pictures.Describe(visit); });
    visit.Group("Solver");
    visit.Integer("max_iterations", &max_iterations, {1, 10000},
                  "Levenberg-Marquardt iterations, of all solves together");
    visit.Flag("covariances", &covariances, "compute the covariance of every landmark");
    visit.OnlyWhere({{"detection_model", {"tangency"}}}, [&] {
      visit.Flag("check_inputs", &check_inputs,
                 "warn where boxes fit clearly better with another focal length or other planes");
    });
  }
};

}  // namespace soslam
