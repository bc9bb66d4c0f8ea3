// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "soslam/evaluation/result_checks.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/angles.h"
#include "soslam/image/edge_maps.h"
#include "soslam/mapping/back_end.h"
#include "soslam/orientation/edge_alignment.h"
#include "soslam/orientation/image_evidence.h"
#include "support/one_body.h"
#include "support/random.h"
#include "support/simulated_points.h"

namespace soslam::calibration {
namespace {

// Whether landmarks are as far from the truth as their covariances say: the normalised estimation
// error squared (NEES) of centre, size and yaw over many random scenes of one body each.

constexpr int kFrames = 8;

// What the back end assumes of the errors, without what it does about wrong assumptions.
OptimiseOptions ModelOptions() {
  OptimiseOptions options;
  options.detection_model = DetectionModel::kTangency;
  options.odometry_rotation_sigma_deg = 0.1;
  options.odometry_translation_sigma_m = 0.003;
  options.upright.huber_delta = 1e6;           // errors are Gaussian
  options.upright.view_correlation_deg = 0.0;  // and independent
  options.upright.axes_weight = 0.0;           // yaws are any
  return options;
}

struct Truth {
  Landmark landmark_in_world;
  ShapePrior prior;
  std::vector<Rigid3d> world_from_camera;
};

// What the errors are, and what the back end takes them for.
struct Case {
  int scenes = 500;
  ShapeExponents shape_exponents = kCuboidExponent;
  double assumed_exponent = kCuboidExponent;
  // Ranges of a / c and b / c: clearly longer than deep, so that one or two views determine the
  // yaw.
  std::array<double, 4> ratio_range = {0.5, 0.7, 1.2, 1.6};
  double arc_rad = 2.5;  // around the object, over all frames
  OptimiseOptions actual = ModelOptions();
  OptimiseOptions assumed = ModelOptions();
  // What is seen of the body's edges; nothing where it is empty.
  std::function<EvidenceOfImages(const Truth&, const EdgeOptions&)> images;
  // Sparse points; none where it is empty.
  std::function<PointsOfObject(const Truth&)> points;
  double ratio_log_sigma = 0.1;
};

Truth RandomTruth(const Case& c, const OptimiseOptions& options) {
  Truth truth;
  truth.prior.shape_exponents = c.assumed_exponent;
  truth.prior.log_sigma = {c.ratio_log_sigma, c.ratio_log_sigma};
  truth.prior.ratio = {RandomUniform(c.ratio_range[0], c.ratio_range[1]),
                       RandomUniform(c.ratio_range[2], c.ratio_range[3])};
  Landmark& landmark = truth.landmark_in_world;
  landmark.shape_exponents = c.shape_exponents;
  landmark.half_axes.z() = RandomUniform(0.3, 0.6);
  for (int i = 0; i < 2; ++i) {
    landmark.half_axes[i] = landmark.half_axes.z() * truth.prior.ratio[i] *
                            std::exp(RandomNormal(truth.prior.log_sigma[i]));
  }
  // Standing on z = 0, as well as bodies are said to stand.
  const double tilt = options.standing_angle_sigma_deg * kRadPerDeg;
  landmark.frame_from_object = {
      ExpRotation({RandomNormal(tilt), RandomNormal(tilt), 0.0}) *
          UprightRotation(Eigen::Vector3d::UnitZ(), RandomUniform(-3, 3)),
      {RandomUniform(-0.1, 0.1), RandomUniform(-0.1, 0.1),
       landmark.half_axes.z() + RandomNormal(options.standing_height_sigma_m)}};
  truth.world_from_camera = CamerasOnArc(kFrames, c.arc_rad);
  return truth;
}

// What is observed of it, with errors as the options say.
Sequence Observe(const Truth& truth, const OptimiseOptions& options) {
  Sequence sequence = ViewsOfBody(truth.landmark_in_world, truth.world_from_camera);
  for (size_t i = 0; i < truth.world_from_camera.size(); ++i) {
    if (i > 0) {
      Rigid3d step = truth.world_from_camera[i - 1].Inverse() * truth.world_from_camera[i];
      step.rotation =
          step.rotation *
          ExpRotation(RandomNormalVector(options.odometry_rotation_sigma_deg * kRadPerDeg));
      step.translation += RandomNormalVector(options.odometry_translation_sigma_m);
      sequence.frames[i].world_from_camera = sequence.frames[i - 1].world_from_camera * step;
    }
    Box& box = sequence.detections[i].box;
    const double sigma_x = options.upright.detection_sigma_fraction * box.Width();
    const double sigma_y = options.upright.detection_sigma_fraction * box.Height();
    box = {box.x_min + RandomNormal(sigma_x), box.y_min + RandomNormal(sigma_y),
           box.x_max + RandomNormal(sigma_x), box.y_max + RandomNormal(sigma_y)};
  }
  return sequence;
}

struct Nees {
  double centre = 0.0;
  double size = 0.0;
  double yaw = 0.0;
};

// Means over scenes of the NEES per degree of freedom.
Nees MeanNees(const Case& c) {
  Nees sum;
  for (int i = 0; i < c.scenes; ++i) {
    const Truth truth = RandomTruth(c, c.actual);
    const Sequence sequence = Observe(truth, c.actual);
    Landmark start = truth.landmark_in_world;
    start.shape_exponents = c.assumed_exponent;
    BackEndInput input{sequence, {start}, {truth.prior}};
    if (c.images) input.images = c.images(truth, c.assumed.edges);
    if (c.points) input.points = {c.points(truth)};
    const MapEstimate map = OptimiseMap(input, c.assumed);
    const Landmark& found = *map.objects[0].landmark_in_world;
    const auto& covariance = map.objects[0].covariance;
    if (!covariance) {
      ADD_FAILURE() << "scene " << i << ": no covariance";
      continue;
    }
    const Eigen::Vector3d centre = found.Centre() - truth.landmark_in_world.Centre();
    const Eigen::Vector3d size =
        (found.half_axes.array() / truth.landmark_in_world.half_axes.array()).log();
    const double yaw = YawDifferenceModuloPi(
        Yaw(Eigen::Vector3d::UnitZ(), found.frame_from_object.rotation),
        Yaw(Eigen::Vector3d::UnitZ(), truth.landmark_in_world.frame_from_object.rotation));
    const auto nees = [&](const Eigen::Vector3d& error, int block) {
      return error.dot(covariance->block<3, 3>(block, block).ldlt().solve(error)) / 3.0;
    };
    sum.centre += nees(centre, 3) / c.scenes;
    sum.size += nees(size, 6) / c.scenes;
    sum.yaw += yaw * yaw / (*covariance)(2, 2) / c.scenes;
  }
  fmt::print("NEES of centre, size, yaw: {:.2f}, {:.2f}, {:.2f}\n", sum.centre, sum.size, sum.yaw);
  return sum;
}

// The range in which the mean NEES of that many degrees of freedom, counted over all scenes, is
// with a probability of 99 % where errors are as their covariances say.
void ExpectWithin99Percent(double mean_nees, int degrees, const char* of) {
  EXPECT_GT(mean_nees, ChiSquareQuantile(degrees, -2.5758)) << of;
  EXPECT_LT(mean_nees, ChiSquareQuantile(degrees, 2.5758)) << of;
}

void ExpectHonest(const Nees& nees, int scenes) {
  ExpectWithin99Percent(nees.centre, 3 * scenes, "centre");
  ExpectWithin99Percent(nees.size, 3 * scenes, "size");
  ExpectWithin99Percent(nees.yaw, scenes, "yaw");
}

// Covariances of the back end for what boxes, odometry, ratios and planes say.

TEST(Calibration, CovariancesAreHonestWhereTheModelHolds) {
  for (const double p : {1.0, 1.3, 2.0}) {
    SCOPED_TRACE(p);
    Case c;
    c.shape_exponents = c.assumed_exponent = p;
    ExpectHonest(MeanNees(c), c.scenes);
  }
}

// A loss that forgives outliers costs next to nothing where there are none.
TEST(Calibration, HoldsUnderTheHuberLoss) {
  Case c;
  c.assumed.upright.huber_delta = OptimiseOptions().upright.huber_delta;
  ExpectHonest(MeanNees(c), c.scenes);
}

TEST(SlowCalibration, HoldsForANearlySquareFootprint) {
  Case c;
  c.ratio_range = {0.9, 1.1, 0.9, 1.1};
  ExpectHonest(MeanNees(c), c.scenes);
}

// In how many of 50 scenes the poses are farther from the odometry than its noise allows.
int ScenesWithFarPoses(const OptimiseOptions& actual, const OptimiseOptions& assumed) {
  int far = 0;
  for (int i = 0; i < 50; ++i) {
    const Truth truth = RandomTruth({}, actual);
    const Sequence sequence = Observe(truth, actual);
    const BackEndInput input{sequence, {truth.landmark_in_world}, {truth.prior}};
    const MapEstimate map = OptimiseMap(input, assumed);
    far += static_cast<int>(
        CheckPoseCorrections(sequence, map.world_from_camera, assumed.Odometry()).size());
  }
  return far;
}

TEST(PoseCorrections, AreFarOnlyWhereOdometryIsWorseThanItsNoise) {
  const OptimiseOptions model = ModelOptions();
  EXPECT_EQ(ScenesWithFarPoses(model, model), 0);
  OptimiseOptions worse = model;
  worse.odometry_rotation_sigma_deg *= 30.0;
  worse.odometry_translation_sigma_m *= 30.0;
  OptimiseOptions robust = model;
  robust.upright.huber_delta = OptimiseOptions().upright.huber_delta;
  EXPECT_GE(ScenesWithFarPoses(worse, model), 45);
  EXPECT_GE(ScenesWithFarPoses(worse, robust), 45);
}

// The cases of the table in docs/shapes.md where it does not hold.
TEST(Calibration, IsCautiousWhereErrorsAreIndependentButTakenForShared) {
  Case c;
  c.assumed.upright.view_correlation_deg = OptimiseOptions().upright.view_correlation_deg;
  const Nees nees = MeanNees(c);
  for (const double mean : {nees.centre, nees.size, nees.yaw}) {
    EXPECT_GT(mean, 0.4);
    EXPECT_LT(mean, 0.8);
  }
}

TEST(SlowCalibration, IsOverconfidentForAWrongShapeButLessWithSharedErrors) {
  Case c;
  c.shape_exponents = 1.3;  // and taken for a cuboid
  const Nees independent = MeanNees(c);
  c.assumed.upright.view_correlation_deg = OptimiseOptions().upright.view_correlation_deg;
  const Nees shared = MeanNees(c);
  EXPECT_GT(independent.size, 25.0);
  EXPECT_GT(independent.centre, 5.0);
  EXPECT_LT(shared.size, 0.6 * independent.size);
  EXPECT_LT(shared.centre, 0.6 * independent.centre);
}

TEST(SlowCalibration, IsOverconfidentOfTheYawOfARoundBody) {
  Case c;
  c.shape_exponents = c.assumed_exponent = kEllipsoidExponent;
  c.ratio_range = {0.9, 1.1, 0.9, 1.1};
  const Nees nees = MeanNees(c);
  ExpectWithin99Percent(nees.centre, 3 * c.scenes, "centre");
  ExpectWithin99Percent(nees.size, 3 * c.scenes, "size");
  c.scenes = 2000;  // so that the bound lies well below the mean, whichever scenes a compiler draws
  EXPECT_GT(MeanNees(c).yaw, ChiSquareQuantile(c.scenes, 2.5758));
}

// Covariances of the back end for what the edges in images say.

// The model that the edge term assumes: pieces of edges of one length, each off by an error of its
// own. Long against the errors, so that the nearest edge is a piece's own.
constexpr double kPiecePx = 25.0;
constexpr double kSigmaPx = 1.5;

// The visible edges of a body in pieces, each drawn to one side of where it is.
EdgeImage DisplacedEdges(const Camera& camera, const Landmark& landmark_in_camera) {
  EdgeMaps maps;
  maps.grey = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
  maps.edges = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
  constexpr int kFractionBits = 8;
  const auto to_image = [](const Eigen::Vector2d& pixel) {
    return cv::Point(static_cast<int>(std::lround(pixel.x() * (1 << kFractionBits))),
                     static_cast<int>(std::lround(pixel.y() * (1 << kFractionBits))));
  };
  for (const ModelPoint& point : VisibleModelPoints(camera, landmark_in_camera, kPiecePx)) {
    const auto pixel =
        camera.Project(landmark_in_camera.frame_from_object *
                       landmark_in_camera.half_axes.cwiseProduct(point.in_unit_body));
    const Eigen::Vector2d across(-point.along.y(), point.along.x());
    const Eigen::Vector2d middle = *pixel + RandomNormal(kSigmaPx) * across;
    const Eigen::Vector2d half = 0.5 * kPiecePx * point.along;
    cv::line(maps.edges, to_image(middle - half), to_image(middle + half), cv::Scalar(255), 1,
             cv::LINE_8, kFractionBits);
  }
  maps.nearest_edge = NearestEdgeMap(maps.edges);
  maps.distance = DistanceMap(maps.nearest_edge);
  return {std::make_shared<const FrameEdges>(maps), *OutlineBox(camera, landmark_in_camera), {}};
}

EvidenceOfImages DisplacedEdgesOfAllViews(const Truth& truth, const EdgeOptions& options) {
  EvidenceOfImages images;
  for (size_t i = 0; i < truth.world_from_camera.size(); ++i) {
    const Landmark in_camera =
        Transform(truth.world_from_camera[i].Inverse(), truth.landmark_in_world);
    images.emplace_back(
        static_cast<int>(i),
        MakeEdgeEvidence(std::make_shared<const EdgeImage>(DisplacedEdges(TestCamera(), in_camera)),
                         TestCamera(), options));
  }
  return images;
}

// The edge_correlation_px with which each piece counts as one: the perimeter of a box for each
// piece of the edges in it, on average.
double PerimeterPerPiece() {
  double perimeters = 0.0;
  double pieces = 0.0;
  for (int i = 0; i < 50; ++i) {
    const Truth truth = RandomTruth(Case(), ModelOptions());
    for (const Rigid3d& world_from_camera : truth.world_from_camera) {
      const Landmark in_camera = Transform(world_from_camera.Inverse(), truth.landmark_in_world);
      const Box box = *OutlineBox(TestCamera(), in_camera);
      perimeters += 2.0 * (box.Width() + box.Height());
      pieces += static_cast<double>(VisibleModelPoints(TestCamera(), in_camera, kPiecePx).size());
    }
  }
  return perimeters / pieces;
}

TEST(SlowEdgeCalibration, CovariancesAreHonestWherePiecesOfEdgesErrIndependently) {
  Case c;
  c.scenes = 100;
  c.images = DisplacedEdgesOfAllViews;
  EdgeOptions& edges = c.assumed.edges;
  edges.edge_sigma_px = kSigmaPx;
  edges.edge_spacing_px = kPiecePx;
  edges.edge_correlation_px = PerimeterPerPiece();
  edges.edge_truncation_px = 20.0 * kSigmaPx;  // no outliers
  edges.edge_direction_tolerance_deg = 90.0;   // no grey values to take directions from
  ExpectHonest(MeanNees(c), c.scenes);
}

// Covariances of the back end for what points say: nearly half of them are of the object, most
// others behind it or in front, and some were triangulated to lie inside it. Boxes and ratios are
// as bad as points are needed for.

struct PointCase {
  double arc_rad;
  int points;
  double range_fraction;  // point_range_fraction
  bool share_drift;       // whether the errors that grow with the range are the same for all points
};

Nees MeanNeesWithPoints(const PointCase& with) {
  Case c;
  c.arc_rad = with.arc_rad;
  c.ratio_log_sigma = 0.2;
  c.actual.upright.detection_sigma_fraction = c.assumed.upright.detection_sigma_fraction = 0.04;
  const PointOptions& options = c.assumed.points;
  c.assumed.points.point_range_fraction = with.range_fraction;
  c.points = [&](const Truth& truth) {
    PointSimulator simulator(truth.landmark_in_world, truth.world_from_camera, options,
                             with.share_drift);
    return simulator.Points(with.points, 0.2, 0.7);
  };
  return MeanNees(c);
}

TEST(SlowPointCalibration, CovariancesAreNearlyHonestWithManyPoints) {
  for (const double arc_rad : {0.6, 1.2}) {
    for (const double range_fraction : {0.005, PointOptions().point_range_fraction}) {
      for (const bool share_drift : {false, true}) {
        SCOPED_TRACE(testing::Message() << arc_rad << " " << range_fraction << " " << share_drift);
        const Nees nees = MeanNeesWithPoints({arc_rad, 80, range_fraction, share_drift});
        for (const double mean : {nees.centre, nees.size}) {
          EXPECT_GT(mean, 0.85);
          EXPECT_LT(mean, 1.25);
        }
        EXPECT_GT(nees.yaw, 0.8);
        EXPECT_LT(nees.yaw, 1.7);
      }
    }
  }
}

// A few points from one side, which weigh as much as many, may all be of something else.
TEST(SlowPointCalibration, CovariancesAreSomewhatOverconfidentWithFewPoints) {
  for (const bool share_drift : {false, true}) {
    const Nees nees = MeanNeesWithPoints({0.6, 20, 0.005, share_drift});
    EXPECT_GT(nees.size, 1.0);
    EXPECT_LT(nees.size, 1.5);
    EXPECT_LT(nees.centre, 1.4);
    EXPECT_LT(nees.yaw, 2.2);
  }
}

}  // namespace
}  // namespace soslam::calibration
