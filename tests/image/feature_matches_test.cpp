// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/feature_matches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <random>

#include "soslam/image/box_mask.h"
#include "support/drawn_photos.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using Pixels = std::vector<Eigen::Vector2d>;

// A histogram of gradients, of which few bins are large as in those of images.
Eigen::ArrayXd RandomHistogram(std::mt19937* random) {
  std::normal_distribution<double> logarithm(0.0, 2.0);
  return Eigen::ArrayXd::NullaryExpr(128, [&] { return std::exp(logarithm(*random)); });
}

Eigen::ArrayXd Disturbed(const Eigen::ArrayXd& histogram, std::mt19937* random) {
  std::normal_distribution<double> logarithm(0.0, 0.3);
  return histogram.unaryExpr([&](double bin) { return bin * std::exp(logarithm(*random)); });
}

// Features with these pixels and histograms.
ImageFeatures FeaturesOf(const Pixels& pixels, const std::vector<Eigen::ArrayXd>& histograms) {
  ImageFeatures features;
  features.pixels.resize(2, std::ssize(pixels));
  features.descriptors.resize(Eigen::NoChange, std::ssize(pixels));
  for (size_t i = 0; i < pixels.size(); ++i) {
    features.pixels.col(i) = pixels[i];
    features.descriptors.col(i) =
        ((histograms[i] / histograms[i].sum()).sqrt() * ImageFeatures::kDescriptorScale)
            .round()
            .min(255.0)
            .cast<std::uint8_t>()
            .matrix();
  }
  return features;
}

// Two views of the same things at given places, one camera at the origin and one beside it.
class FeatureMatchesTest : public testing::Test {
 protected:
  // Matches between features that look alike, where their indices are the same, and like no others.
  std::vector<FeatureMatch> MatchAlike(const Pixels& first, const Pixels& second) {
    std::vector<Eigen::ArrayXd> histograms;
    for (size_t i = 0; i < std::max(first.size(), second.size()); ++i) {
      histograms.push_back(RandomHistogram(&random_));
    }
    const FeatureView left{camera_, {}, FeaturesOf(first, histograms)};
    for (Eigen::ArrayXd& histogram : histograms) histogram = Disturbed(histogram, &random_);
    return MatchFeatures(left, {camera_, second_, FeaturesOf(second, histograms)}, options_);
  }

  // Random points in front of both cameras, as both show them but for noise.
  std::pair<Pixels, Pixels> RandomPoints(int count, double noise_px) {
    std::uniform_real_distribution<double> place(-1.0, 1.0), depth(2.0, 8.0);
    std::normal_distribution<double> noise(0.0, noise_px);
    const auto noisy = [&](const Eigen::Vector2d& pixel) {
      return Eigen::Vector2d(pixel + Eigen::Vector2d(noise(random_), noise(random_)));
    };
    std::pair<Pixels, Pixels> pixels;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d point(place(random_), place(random_), depth(random_));
      pixels.first.push_back(noisy(*camera_.Project(point)));
      pixels.second.push_back(noisy(*camera_.Project(second_.Inverse() * point)));
    }
    return pixels;
  }

  std::mt19937 random_{3};
  Camera camera_{640, 480, 500.0, 500.0, 319.5, 239.5};
  Rigid3d second_ = {ExpRotation({0.05, -0.1, 0.2}), {0.5, 0.1, -0.2}};  // world_from_camera
  MatchOptions options_;
};

TEST_F(FeatureMatchesTest, PointsOfTwoViewsAreMatched) {
  auto [first, second] = RandomPoints(300, 0.3);
  // Other things that only one view shows.
  std::uniform_real_distribution<double> x(0.0, 640.0), y(0.0, 480.0);
  for (int i = 0; i < 200; ++i) first.emplace_back(x(random_), y(random_));
  const std::vector<FeatureMatch> matches = MatchAlike(first, second);
  EXPECT_GT(matches.size(), 290u);
  for (const FeatureMatch& match : matches) {
    EXPECT_EQ(match.first, match.second);
    EXPECT_LT(match.distance, 0.3);
  }
}

TEST_F(FeatureMatchesTest, WhatIsNotOnTheEpipolarLineIsNoMatch) {
  auto [first, second] = RandomPoints(40, 0.0);
  // The epipolar lines are about along the motion, which is to the right.
  for (int i = 0; i < 20; ++i) second[i].y() += i < 10 ? 2.0 : 25.0;
  std::vector<int> matched;
  for (const FeatureMatch& match : MatchAlike(first, second)) matched.push_back(match.first);
  EXPECT_EQ(matched.size(), 30u);
  EXPECT_TRUE(std::ranges::none_of(matched, [](int i) { return i >= 10 && i < 20; }));
}

// A camera that moves to the right sees things move to the left, or stay where they are far away.
TEST_F(FeatureMatchesTest, RaysMeetInFrontOfBothCamerasOrAtInfinity) {
  second_ = {Eigen::Quaterniond::Identity(), {0.5, 0.0, 0.0}};
  const Pixels first = {{100, 50}, {200, 100}, {300, 150}, {400, 200}, {500, 250}};
  Pixels second = first;
  second[0].x() -= 60.0;
  second[1].x() += 0.0;
  second[2].x() += 2.0;
  second[3].x() += 5.0;
  second[4].x() += 100.0;
  std::vector<int> matched;
  for (const FeatureMatch& match : MatchAlike(first, second)) matched.push_back(match.first);
  EXPECT_THAT(matched, ElementsAre(0, 1, 2));
  // Forwards, they move away from the centre.
  second_.translation = {0.0, 0.0, 0.5};
  const Eigen::Vector2d centre(camera_.cx, camera_.cy);
  for (size_t i = 0; i < first.size(); ++i) {
    second[i] = centre + (i < 3 ? 1.2 : 0.8) * (first[i] - centre);
  }
  matched.clear();
  for (const FeatureMatch& match : MatchAlike(first, second)) matched.push_back(match.first);
  EXPECT_THAT(matched, ElementsAre(0, 1, 2));
}

TEST_F(FeatureMatchesTest, ACameraThatOnlyTurnsFindsThingsWhereTheRotationMovesThem) {
  second_.translation = {10.0, 20.0, 30.0};
  const Rigid3d first_pose = {Eigen::Quaterniond::Identity(), second_.translation};
  Pixels first, second;
  std::vector<Eigen::ArrayXd> histograms;
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector2d pixel(20.0 * i, 10.0 * i);
    const Eigen::Vector3d ray = second_.rotation.conjugate() * camera_.Ray(pixel);
    first.push_back(pixel);
    second.push_back(*camera_.Project(ray) + Eigen::Vector2d(i < 20 ? 1.0 : 5.0, 0.0));
    histograms.push_back(RandomHistogram(&random_));
  }
  const auto matches = MatchFeatures({camera_, first_pose, FeaturesOf(first, histograms)},
                                     {camera_, second_, FeaturesOf(second, histograms)}, options_);
  ASSERT_EQ(matches.size(), 20u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(matches[i].first, i);
  // Behind the camera is nothing.
  second_.rotation = ExpRotation({0.0, 3.1, 0.0});
  EXPECT_THAT(MatchFeatures({camera_, first_pose, FeaturesOf(first, histograms)},
                            {camera_, second_, FeaturesOf(first, histograms)}, options_),
              IsEmpty());
}

// Things that look the same, side by side along the epipolar line, in either view.
TEST_F(FeatureMatchesTest, WhatLooksTheSameElsewhereIsNoMatch) {
  second_ = {Eigen::Quaterniond::Identity(), {0.5, 0.0, 0.0}};
  const std::vector<Eigen::ArrayXd> same(2, RandomHistogram(&random_));
  const FeatureView one{camera_, {}, FeaturesOf({{400.0, 100.0}}, same)};
  const auto two = [&](double apart_px) {
    const Pixels pixels = {{340.0, 100.0}, {340.0 + apart_px, 100.0}};
    return FeatureView{camera_, second_, FeaturesOf(pixels, same)};
  };
  EXPECT_THAT(MatchFeatures(one, two(20.0), options_), IsEmpty());
  EXPECT_THAT(MatchFeatures(two(20.0), one, options_), IsEmpty());
  EXPECT_EQ(MatchFeatures(one, two(5.0), options_).size(), 1u);  // the same thing twice
}

TEST_F(FeatureMatchesTest, WhatLooksDifferentIsNoMatch) {
  const auto [first, second] = RandomPoints(1, 0.0);
  const FeatureView left{camera_, {}, FeaturesOf(first, {RandomHistogram(&random_)})};
  const FeatureView right{camera_, second_, FeaturesOf(second, {RandomHistogram(&random_)})};
  EXPECT_THAT(MatchFeatures(left, right, options_), IsEmpty());
  options_.max_descriptor_distance = 1.5;
  EXPECT_EQ(MatchFeatures(left, right, options_).size(), 1u);
  EXPECT_THAT(MatchFeatures(left, {camera_, second_, FeaturesOf({}, {})}, options_), IsEmpty());
}

TEST(ImagePairsTest, AreCloseOrFurtherApartBySteps) {
  std::vector<int> partners;
  for (const auto& [first, second] : ImagePairs(std::vector<int>(60))) {
    if (first == 0) partners.push_back(second);
  }
  EXPECT_THAT(partners,
              ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 17, 20, 24, 29, 35, 42, 50));
  EXPECT_THAT(ImagePairs({0, 0, 3, 3}), ElementsAre(Pair(0, 1), Pair(2, 3)));
  EXPECT_THAT(ImagePairs({0}), IsEmpty());
}

// Three cameras side by side, which see two things twice at one pixel and another elsewhere.
class JoinMatchesTest : public testing::Test {
 protected:
  JoinMatchesTest() {
    const Camera camera{640, 480, 500.0, 500.0, 319.5, 239.5};
    for (int i = 0; i < 3; ++i) {
      const Pixels pixels = {{300.0 - 20.0 * i, 100.0}, {300.0 - 20.0 * i, 100.0}, {400.0, 100.0}};
      views_.push_back(
          {camera,
           {Eigen::Quaterniond::Identity(), {100.0 + 0.1 * i, 50.0, 0.0}},
           FeaturesOf(pixels, std::vector<Eigen::ArrayXd>(3, Eigen::ArrayXd::Ones(128)))});
    }
  }
  // "image:x" of each place.
  std::vector<std::string> Join(const std::vector<std::vector<FeatureMatch>>& matches,
                                double max_error_px = 1e6) const {
    std::vector<std::string> texts;
    for (const FeatureTrack& track : JoinMatches(views_, {{0, 1}, {0, 2}, {1, 2}}, matches,
                                                 {.max_reprojection_error_px = max_error_px})) {
      std::string& text = texts.emplace_back();
      for (const auto& [image, pixel] : track.places) {
        text += (text.empty() ? "" : " ") + std::to_string(image) + ":" +
                std::to_string(static_cast<int>(pixel.x()));
      }
    }
    return texts;
  }
  std::vector<FeatureView> views_;
};

TEST_F(JoinMatchesTest, TracksHaveOnePixelOfAnImage) {
  EXPECT_THAT(Join({{{0, 0, 0.1F}}, {}, {{0, 0, 0.1F}}}), ElementsAre("0:300 1:280 2:260"));
  // The match between images 0 and 2 contradicts the two others, of which the worse one yields.
  EXPECT_THAT(Join({{{0, 0, 0.1F}}, {{0, 2, 0.2F}}, {{0, 0, 0.3F}}}),
              ElementsAre("0:300 1:280 2:400"));
  EXPECT_THAT(Join({{{0, 0, 0.1F}}, {{0, 2, 0.3F}}, {{0, 0, 0.2F}}}),
              ElementsAre("0:300 1:280 2:260"));
  EXPECT_THAT(Join({{{2, 2, 0.1F}, {0, 0, 0.1F}}, {}, {}}),
              ElementsAre("0:300 1:280", "0:400 1:400"));
  EXPECT_THAT(Join({{}, {}, {}}), IsEmpty());
}

TEST_F(JoinMatchesTest, FeaturesOfOnePixelAreOnePoint) {
  EXPECT_THAT(Join({{{0, 0, 0.1F}}, {}, {{1, 0, 0.3F}}}), ElementsAre("0:300 1:280 2:260"));
}

// Each pair of pixels alone lies on epipolar lines.
TEST_F(JoinMatchesTest, TracksAreOfOnePoint) {
  EXPECT_THAT(Join({{{0, 0, 0.1F}}, {}, {{0, 0, 0.2F}}}, 0.1), ElementsAre("0:300 1:280 2:260"));
  EXPECT_THAT(Join({{{2, 2, 0.1F}}, {}, {{2, 2, 0.2F}}}, 0.1), ElementsAre("0:400 1:400 2:400"))
      << "a point at infinity";
  views_[2].features.pixels(0, 0) = views_[2].features.pixels(0, 1) = 190.0;
  EXPECT_THAT(Join({{{0, 0, 0.1F}}, {}, {{0, 0, 0.2F}}}, 5.0), ElementsAre("0:300 1:280"));
  EXPECT_EQ(Join({{{0, 0, 0.1F}}, {}, {{0, 0, 0.2F}}}, 30.0).size(), 1u);
  // The cameras have one place.
  for (FeatureView& view : views_) view.world_from_camera.translation.setZero();
  EXPECT_THAT(Join({{{2, 2, 0.1F}}, {}, {{2, 2, 0.2F}}}, 0.1), ElementsAre("0:400 1:400 2:400"));
  EXPECT_THAT(Join({{{0, 0, 0.1F}}, {}, {{0, 0, 0.2F}}}, 5.0), IsEmpty());
}

TEST(FindFeaturesTest, DescriptorsAreUnitVectorsAndPixelsInOrder) {
  const ImageFeatures features = FindFeatures(GreyOf(DrawnView(0)), {.max_features = 200});
  const Eigen::Index count = features.pixels.cols();
  EXPECT_GE(count, 100);
  EXPECT_LE(count, 220);  // equally strong ones are kept
  ASSERT_EQ(features.descriptors.cols(), count);
  const Eigen::VectorXd x = features.pixels.row(0);
  EXPECT_TRUE(std::is_sorted(x.begin(), x.end()));
  for (Eigen::Index i = 0; i < count; ++i) {
    const float norm = features.descriptors.col(i).cast<float>().norm();
    EXPECT_NEAR(norm / ImageFeatures::kDescriptorScale, 1.0, 0.02);
  }
}

TEST(OutsideOfTest, MasksThePixelsWhoseCentresAreInBoxes) {
  const auto masked = [](const Box& box) {
    return 12 * 10 - cv::countNonZero(MaskOutBoxes({box}, {12, 10}));
  };
  EXPECT_EQ(masked({2.0, 3.0, 4.0, 4.0}), 3 * 2);
  EXPECT_EQ(masked({1.9, 2.9, 4.1, 4.1}), 3 * 2);
  EXPECT_EQ(masked({2.1, 3.0, 2.9, 4.0}), 0);
  EXPECT_EQ(masked({-50.0, -50.0, 500.0, 500.0}), 12 * 10);
  EXPECT_EQ(masked({12.0, 0.0, 20.0, 5.0}), 0);
}

TEST(FindFeaturesTest, NothingInAnEmptyOrTinyImage) {
  for (const cv::Size size : {cv::Size(64, 48), cv::Size(1, 1), cv::Size(3, 200)}) {
    const ImageFeatures features = FindFeatures(cv::Mat(size, CV_8UC1, cv::Scalar(90)), {});
    EXPECT_EQ(features.pixels.cols(), 0);
    EXPECT_EQ(features.descriptors.cols(), 0);
  }
}

}  // namespace
}  // namespace soslam
