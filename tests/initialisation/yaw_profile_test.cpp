// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "soslam/geometry/angles.h"
#include "soslam/initialisation/fit_object.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(CircularMinima, AreSortedAndOfPlateausTheFirstIndices) {
  const struct {
    std::vector<double> values;
    std::vector<size_t> minima;
  } cases[] = {
      {{0, 1, 2, 1}, {0}},
      {{1, 2, 1, 0}, {3}},
      {{1, 0, 1, 2, 3, 2}, {1}},
      {{2, 5, 1, 5}, {2, 0}},
      {{3, 1, 1, 1, 3, 2}, {1, 5}},
      {{1, 1, 2, 3, 1}, {4}},  // goes round the end
      {{1, 2, 3, 1, 1}, {3}},
      {{1, 2, 2, 3, 2, 2}, {0}},  // steps on the way are none
      {{1, 1, 5, 1, 5}, {0, 3}},  // equal ones in their order
      {{4, 4, 4, 4}, {0}},        // a constant
      {{}, {}},
      {{kNaN, kNaN}, {}},  // counts as high
      {{kNaN, 2, kNaN, 1, 3}, {3, 1}},
      {{2, 2, kNaN}, {0}},
      {{2, kNaN, 2}, {2}},
      {{kNaN, 3, 2, kNaN, 2, 1}, {5, 2}},
  };
  for (const auto& one : cases) EXPECT_EQ(CircularMinima(one.values), one.minima);
}

TEST(ProfileOverYaw, CoversHalfATurnWithLandmarksAtTheirYaws) {
  for (const double step_deg : {1.0, 3.0, 7.0, 45.0}) {
    const ObservedBody body(1.5);
    const YawProfile profile = ProfileOverYaw(body.evidence, step_deg * kRadPerDeg);
    ASSERT_EQ(profile.yaw.size(), static_cast<size_t>(std::lround(180.0 / step_deg)));
    ASSERT_EQ(profile.fits.size(), profile.yaw.size());
    const std::vector<double> costs = profile.Costs();
    const double step = std::numbers::pi / static_cast<double>(profile.yaw.size());
    for (size_t i = 0; i < profile.yaw.size(); ++i) {
      EXPECT_NEAR(profile.yaw[i], step * static_cast<double>(i), 1e-12);
      ASSERT_TRUE(profile.fits[i]);
      EXPECT_EQ(costs[i], profile.fits[i]->cost.total);
      const Landmark& landmark = profile.fits[i]->landmark;
      const double yaw = Yaw(body.plane.normal, landmark.frame_from_object.rotation);
      EXPECT_NEAR(YawDifferenceModuloPi(yaw, profile.yaw[i]), 0.0, 1e-9);
      EXPECT_NEAR(body.plane.SignedDistance(landmark.Centre()), landmark.half_axes.z(), 1e-9);
      EXPECT_EQ(landmark.shape_exponents, 1.5);
      EXPECT_TRUE(IsInFront(landmark));
    }
  }
}

// A profile whose costs are a function of the yaw.
template <typename Cost>
YawProfile ProfileOf(Cost cost, int points) {
  YawProfile profile;
  for (int i = 0; i < points; ++i) {
    profile.yaw.push_back(i * std::numbers::pi / points);
    profile.fits.push_back(ObjectFit{{}, {.total = cost(profile.yaw.back())}});
  }
  return profile;
}

TEST(YawProfile, StandardDeviationOfAGaussianLikelihoodIsItsSigma) {
  for (int i = 0; i < 50; ++i) {
    const double sigma = RandomUniform(2.0, 10.0) * kRadPerDeg;
    const double mean = RandomYaw();  // also where the grid goes round
    const double offset = RandomUniform(-1e4, 1e4);
    const auto cost = [&](double yaw) {
      return offset + 0.5 * std::pow(YawDifferenceModuloPi(yaw, mean) / sigma, 2);
    };
    const YawProfile profile = ProfileOf(cost, 360);
    EXPECT_NEAR(profile.StandardDeviation({{mean, offset}}), sigma, 0.02 * sigma);
    EXPECT_NEAR(profile.StandardDeviation({{mean + std::numbers::pi, offset}}), sigma,
                0.02 * sigma);
    // About another yaw, the way there counts too.
    const double away = mean + RandomUniform(-0.3, 0.3);
    EXPECT_NEAR(profile.StandardDeviation({{away, cost(away)}}),
                std::hypot(sigma, YawDifferenceModuloPi(away, mean)), 0.01);
  }
}

// The same body called by its other horizontal axis: two equal peaks a quarter turn apart.
TEST(YawProfile, StandardDeviationOfAQuarterTurnAmbiguity) {
  for (int i = 0; i < 50; ++i) {
    const double sigma = RandomUniform(0.3, 3.0) * kRadPerDeg;
    const double mean = RandomYaw();
    const double other = mean + 0.5 * std::numbers::pi;
    const YawProfile profile = ProfileOf(
        [&](double yaw) {
          const auto squared = [&](double peak) {
            return 0.5 * std::pow(YawDifferenceModuloPi(yaw, peak) / sigma, 2);
          };
          return std::min(squared(mean), squared(other));
        },
        60);
    const double expected = 0.5 * std::numbers::pi / std::sqrt(2.0);
    EXPECT_NEAR(profile.StandardDeviation({{mean, 0.0}, {other, 0.0}}), expected, 0.06 * expected);
  }
}

TEST(YawProfile, StandardDeviationLeavesOutYawsWithoutALandmark) {
  // Nothing but 20 degrees around the mean, and 10 degrees further on.
  YawProfile profile = ProfileOf([](double) { return 1.0; }, 1800);
  const double mean = 80.05 * kRadPerDeg;
  const auto leave_out = [&](double from, double to) {
    for (size_t i = 0; i < profile.yaw.size(); ++i) {
      const double distance = (profile.yaw[i] - mean) / kRadPerDeg;
      if (distance > from && distance < to) profile.fits[i].reset();
    }
  };
  leave_out(-90, -10);
  leave_out(20, 101);
  EXPECT_NEAR(profile.StandardDeviation({{mean, 1.0}}), std::sqrt(9000.0 / 3.0 / 30.0) * kRadPerDeg,
              1e-3);
  leave_out(10, 20);
  EXPECT_NEAR(profile.StandardDeviation({{mean, 1.0}}), 20.0 * kRadPerDeg / std::sqrt(12.0), 1e-3);
}

TEST(YawProfile, StandardDeviationOfAYawAloneIsThatOfItsStep) {
  for (const double others_cost : {100.0, 800.0, 1e5}) {
    YawProfile profile = ProfileOf([&](double yaw) { return yaw == 0.0 ? 0.0 : others_cost; }, 60);
    profile.fits[1].reset();
    profile.fits[59].reset();
    const double step = std::numbers::pi / 60.0;
    for (const double rounding : {0.0, 4e-16, -1e-12}) {
      EXPECT_NEAR(profile.StandardDeviation({{rounding, 0.0}}), step / std::sqrt(12.0), 1e-6);
    }
  }
}

}  // namespace
}  // namespace soslam
