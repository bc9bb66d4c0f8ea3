// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include "soslam/geometry/angles.h"
#include "soslam/initialisation/fit_object.h"
#include "soslam/initialisation/object_evidence.h"
#include "support/one_body.h"
#include "support/pictures.h"
#include "support/scene.h"

namespace soslam {
namespace {

constexpr double kYawStep = 2.0 * std::numbers::pi / kYawsOfPictures;

// A body that is as wide as it is deep: boxes do not tell its yaw.
Landmark RoundBody(double yaw) {
  Landmark body;
  body.shape_exponents = kEllipsoidExponent;
  body.half_axes = {0.3, 0.3, 0.4};
  body.frame_from_object = {UprightRotation(Eigen::Vector3d::UnitZ(), yaw), {0.1, -0.2, 0.4}};
  return body;
}

// The angle (rad) from one yaw to another, over the full circle.
double Difference(double yaw, double other) {
  return std::remainder(yaw - other, 2.0 * std::numbers::pi);
}

double LowestYaw(const std::vector<double>& costs) {
  return kYawStep * static_cast<double>(std::ranges::min_element(costs) - costs.begin());
}

std::vector<Rigid3d> RandomCameras(int count) {
  std::vector<Rigid3d> cameras;
  while (static_cast<int>(cameras.size()) < count) {
    const Eigen::Vector3d position = RandomVector(-4, 4) + Eigen::Vector3d(0, 0, 4.5);
    if (position.head<2>().norm() < 2.0) continue;
    Rigid3d camera = LookingAt(position, {0.1, -0.2, RandomUniform(0.2, 0.6)});
    camera.rotation =
        camera.rotation * Eigen::AngleAxisd(RandomUniform(-0.5, 0.5), Eigen::Vector3d::UnitZ());
    cameras.push_back(camera);
  }
  return cameras;
}

TEST(PictureCosts, AreLowestAtTheTrueYawInAnyWorld) {
  for (int i = 0; i < 20; ++i) {
    Sequence sequence = TransformSequence(
        RandomRigid(), ViewsOfBody(RoundBody(RandomUniform(-3, 3)), RandomCameras(1 + i % 4)));
    AddTruePictures(&sequence);
    const Plane& plane = sequence.planes[0].plane_in_world;
    const Landmark& truth = sequence.objects[0].ground_truth->landmark_in_world;
    const ObjectEvidence evidence =
        EvidenceInWorld(sequence, DetectionsByObject(sequence)[0], std::nullopt, {});
    ASSERT_EQ(evidence.picture_costs.size(), static_cast<size_t>(kYawsOfPictures));
    EXPECT_LT(std::abs(Difference(LowestYaw(evidence.picture_costs),
                                  Yaw(plane.normal, truth.frame_from_object.rotation))),
              1.01 * kYawStep);
  }
}

TEST(PictureCosts, AreLowestAtTheTrueYawInTheCamera) {
  for (int i = 0; i < 20; ++i) {
    Sequence sequence = ViewsOfBody(RoundBody(RandomUniform(-3, 3)), RandomCameras(2));
    AddTruePictures(&sequence);
    for (const Detection& detection : sequence.detections) {
      const ObjectEvidence evidence = EvidenceInCamera(sequence, detection, std::nullopt, {});
      const Landmark truth = *TrueLandmarkInCamera(sequence, detection);
      EXPECT_LT(std::abs(Difference(
                    LowestYaw(evidence.picture_costs),
                    Yaw(detection.plane_in_camera.normal, truth.frame_from_object.rotation))),
                1.01 * kYawStep);
    }
  }
}

TEST(PictureCosts, AreNoneWithoutPictures) {
  const Sequence sequence = ViewsOfBody(RoundBody(0.3), RandomCameras(3));
  const ObjectEvidence evidence =
      EvidenceInWorld(sequence, DetectionsByObject(sequence)[0], std::nullopt, {});
  EXPECT_TRUE(evidence.picture_costs.empty());
  EXPECT_TRUE(HalfTurnCosts({}).empty());
}

TEST(PictureCosts, AreThoseOfThePicturesThatTellAnAzimuth) {
  BoxAppearance nothing;
  nothing.azimuth_costs.setZero();
  const PictureView silent{std::make_shared<const BoxAppearance>(nothing),
                           Eigen::Vector3d(0.0, 1.0, 0.0)};
  const PictureView telling{std::make_shared<const BoxAppearance>(PictureFrom(0.4)),
                            silent.ray_in_reference};
  EXPECT_TRUE(PictureCosts({silent, silent}, Plane()).empty());
  EXPECT_EQ(PictureCosts({silent, telling}, Plane()), PictureCosts({telling}, Plane()));
}

// Many pictures from one direction tell no more than one.
TEST(PictureCosts, PicturesOfOneDirectionCountAsOne) {
  BoxAppearance picture = PictureFrom(0.4);
  picture.direction_correlation_deg = 20.0F;
  const auto shared = std::make_shared<const BoxAppearance>(picture);
  const PictureView view{shared, Eigen::Vector3d(1.0, 0.2, -0.3)};
  const auto one = PictureCosts({view}, Plane());
  const auto many = PictureCosts({view, view, view, view}, Plane());
  for (size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(many[i], one[i], 1e-9);
  const PictureView far{shared, Eigen::Vector3d(-1.0, 0.2, -0.3)};
  const auto both = PictureCosts({view, far}, Plane()), other = PictureCosts({far}, Plane());
  for (size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(both[i], one[i] + other[i], 1e-3);
}

// A picture of a thing that is as deep as this, relative to its height.
PictureView PictureOfDepth(double ratio, double sigma, const Eigen::Vector3d& ray) {
  BoxAppearance picture = PictureFrom(0.4);
  picture.direction_correlation_deg = 20.0F;
  picture.log_ratios = LogRatios{Eigen::Vector2d(std::log(ratio), 0.1).cast<float>(),
                                 Eigen::Vector2d(sigma, 0.5).cast<float>()};
  return {std::make_shared<const BoxAppearance>(picture), ray};
}

const ShapePrior kWidePrior{.ratio = {1.0, 1.0}, .log_sigma = {100.0, 100.0}};

TEST(PriorWithPictures, IsTheMeanOfPicturesAndAsSureAsOne) {
  const std::array directions = {Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d(-1.0, 0.0, 0.0),
                                 Eigen::Vector3d(0.0, 1.0, 0.0), Eigen::Vector3d(0.0, -1.0, 0.0)};
  std::vector<PictureView> pictures;
  double product = 1.0;
  for (const Eigen::Vector3d& direction : directions) {
    const double ratio = RandomUniform(0.5, 2.0);
    product *= ratio;
    pictures.push_back(PictureOfDepth(ratio, 0.2, direction));
  }
  const ShapePrior told = *PriorWithPictures(kWidePrior, pictures);
  EXPECT_NEAR(told.ratio.x(), std::pow(product, 0.25), 1e-4);
  EXPECT_NEAR(told.log_sigma.x(), 0.2, 1e-4);
}

TEST(PriorWithPictures, PicturesOfOneDirectionCountAsOne) {
  const PictureView picture = PictureOfDepth(1.7, 0.2, {1.0, 0.2, -0.3});
  const ShapePrior one = *PriorWithPictures(kWidePrior, {picture});
  const ShapePrior many = *PriorWithPictures(kWidePrior, {picture, picture, picture});
  EXPECT_NEAR(one.ratio.x(), 1.7, 1e-4);
  EXPECT_NEAR(one.log_sigma.x(), 0.2, 1e-4);
  EXPECT_LT((many.ratio - one.ratio).norm(), 1e-6);
  EXPECT_LT((many.log_sigma - one.log_sigma).norm(), 1e-6);
}

TEST(PriorWithPictures, IsThePriorOfAllPicturesInTheWorldAndOfOneInACamera) {
  Sequence sequence = ViewsOfBody(RoundBody(0.3), RandomCameras(2));
  for (size_t i = 0; i < 2; ++i) {
    const PictureView picture = PictureOfDepth(i == 0 ? 1.0 : 4.0, 0.2, Eigen::Vector3d::UnitX());
    BoxAppearance appearance = *picture.appearance;
    appearance.direction_correlation_deg = 0.0F;  // both count the same
    sequence.detections[i].appearance = std::make_shared<const BoxAppearance>(appearance);
    EXPECT_NEAR(EvidenceInCamera(sequence, sequence.detections[i], kWidePrior, {}).prior->ratio.x(),
                i == 0 ? 1.0 : 4.0, 1e-3);
  }
  EXPECT_NEAR(EvidenceInWorld(sequence, {0, 1}, kWidePrior, {}).prior->ratio.x(), 2.0, 1e-3);
}

TEST(PriorWithPictures, SaysNothingOfWhatNeedNotStandAndWithoutRatios) {
  const PictureView picture = PictureOfDepth(1.7, 0.2, {1.0, 0.2, -0.3});
  const PictureView without{std::make_shared<const BoxAppearance>(PictureFrom(0.4)),
                            picture.ray_in_reference};
  ShapePrior lying = kWidePrior;
  lying.attitude = Attitude::kAnyFace;
  EXPECT_EQ(PriorWithPictures(lying, {picture})->ratio, lying.ratio);
  EXPECT_EQ(PriorWithPictures(kWidePrior, {without})->ratio, kWidePrior.ratio);
  EXPECT_FALSE(PriorWithPictures(std::nullopt, {picture}));
}

TEST(HalfTurnCosts, AddTheLikelihoodsOfOppositeYaws) {
  std::vector<double> costs(kYawsOfPictures);
  for (double& cost : costs) cost = RandomUniform(0.0, 40.0);
  const auto half = HalfTurnCosts(costs);
  ASSERT_EQ(half.size(), costs.size() / 2);
  EXPECT_EQ(*std::ranges::min_element(half), 0.0);
  const auto likelihood = [&](size_t i) {
    return std::exp(-costs[i]) + std::exp(-costs[i + half.size()]);
  };
  for (size_t i = 1; i < half.size(); ++i) {
    EXPECT_NEAR(half[i] - half[0], std::log(likelihood(0)) - std::log(likelihood(i)), 1e-9);
  }
}

TEST(FrontProbability, IsThatOfTheFrontAgainstTheBack) {
  const Plane plane = RandomPlane();
  std::vector<double> costs(kYawsOfPictures);
  for (double& cost : costs) cost = RandomUniform(0.0, 5.0);
  for (int i = 0; i < kYawsOfPictures; ++i) {
    Landmark landmark;
    landmark.frame_from_object.rotation = UprightRotation(plane.normal, kYawStep * i);
    const double front = std::exp(-costs[i]);
    const double back = std::exp(-costs[(i + kYawsOfPictures / 2) % kYawsOfPictures]);
    EXPECT_NEAR(FrontProbability(costs, plane, landmark), front / (front + back), 1e-9);
  }
  for (int i = 0; i < 20; ++i) {
    Landmark landmark;
    landmark.frame_from_object.rotation = UprightRotation(plane.normal, RandomUniform(-3, 3));
    const double front = FrontProbability(costs, plane, landmark);
    const double back = FrontProbability(costs, plane, RotatedAboutZ(landmark, std::numbers::pi));
    EXPECT_NEAR(front + back, 1.0, 1e-9);
  }
}

TEST(PictureCosts, AreOfNoAccountForWhatDoesNotStand) {
  Sequence sequence = ViewsOfBody(RoundBody(0.3), RandomCameras(3));
  AddTruePictures(&sequence);
  for (const Mount mount : {Mount::kStanding, Mount::kHanging, Mount::kOnWall}) {
    ShapePrior prior;
    prior.mount = mount;
    ObjectEvidence evidence =
        EvidenceInWorld(sequence, DetectionsByObject(sequence)[0], prior, {.axes_weight = 0.0});
    const size_t terms = PriorTerms(evidence).size();
    evidence.picture_costs.clear();
    EXPECT_EQ(terms - PriorTerms(evidence).size(), mount == Mount::kStanding ? 1u : 0u);
  }
}

TEST(FitObject, APictureTellsTheYawThatBoxesDoNot) {
  for (int i = 0; i < 8; ++i) {
    const double yaw = RandomUniform(-3, 3);
    Sequence sequence = ViewsOfBody(RoundBody(yaw), CamerasOnArc(6, 2.0));
    AddTruePictures(&sequence);
    const ShapePrior prior{{0.75, 0.75}, {0.05, 0.05}, kEllipsoidExponent};
    const ObjectEvidence evidence =
        EvidenceInWorld(sequence, DetectionsByObject(sequence)[0], prior, {.axes_weight = 0.0});
    const auto fits = FitObject(evidence, 3.0 * kRadPerDeg, 1);
    ASSERT_EQ(fits.size(), 1u);
    const double found = Yaw(Eigen::Vector3d::UnitZ(), fits[0].landmark.frame_from_object.rotation);
    EXPECT_LT(std::abs(YawDifferenceModuloPi(found, yaw)), 2.5 * kRadPerDeg) << yaw;
    EXPECT_LT(fits[0].cost.total, 0.05);
  }
}

}  // namespace
}  // namespace soslam
