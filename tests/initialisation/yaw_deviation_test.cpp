// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/angles.h"
#include "initialisation/yaw_sweep.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

// A sweep whose costs are a function of the yaw.
template <typename Cost>
YawSweep SweepOf(Cost cost, int points) {
  YawSweep sweep;
  for (int i = 0; i < points; ++i) {
    sweep.yaw.push_back(i * std::numbers::pi / points);
    sweep.fits.push_back(UprightFit{UprightVector::Zero(), cost(sweep.yaw.back())});
  }
  return sweep;
}

TEST(YawSweep, StandardDeviationOfAGaussianLikelihoodIsItsSigma) {
  for (int i = 0; i < 50; ++i) {
    const double sigma = RandomUniform(2.0, 10.0) * kRadPerDeg;
    const double mean = RandomYaw();  // also where the grid goes round
    const double offset = RandomUniform(-1e4, 1e4);
    const auto cost = [&](double yaw) {
      return offset + 0.5 * std::pow(YawDifferenceModuloPi(yaw, mean) / sigma, 2);
    };
    const YawSweep sweep = SweepOf(cost, 360);
    EXPECT_NEAR(sweep.StandardDeviation({{mean, offset}}), sigma, 0.02 * sigma);
    EXPECT_NEAR(sweep.StandardDeviation({{mean + std::numbers::pi, offset}}), sigma, 0.02 * sigma);
    // About another yaw, the way there counts too.
    const double away = mean + RandomUniform(-0.3, 0.3);
    EXPECT_NEAR(sweep.StandardDeviation({{away, cost(away)}}),
                std::hypot(sigma, YawDifferenceModuloPi(away, mean)), 0.01);
  }
}

// The same body called by its other horizontal axis: two equal peaks a quarter turn apart.
TEST(YawSweep, StandardDeviationOfAQuarterTurnAmbiguity) {
  for (int i = 0; i < 50; ++i) {
    const double sigma = RandomUniform(0.3, 3.0) * kRadPerDeg;
    const double mean = RandomYaw();
    const double other = mean + 0.5 * std::numbers::pi;
    const YawSweep sweep = SweepOf(
        [&](double yaw) {
          const auto squared = [&](double peak) {
            return 0.5 * std::pow(YawDifferenceModuloPi(yaw, peak) / sigma, 2);
          };
          return std::min(squared(mean), squared(other));
        },
        60);
    const double expected = 0.5 * std::numbers::pi / std::sqrt(2.0);
    EXPECT_NEAR(sweep.StandardDeviation({{mean, 0.0}, {other, 0.0}}), expected, 0.06 * expected);
  }
}

TEST(YawSweep, StandardDeviationLeavesOutYawsWithoutALandmark) {
  // Nothing but 20 degrees around the mean, and 10 degrees further on.
  YawSweep sweep = SweepOf([](double) { return 1.0; }, 1800);
  const double mean = 80.05 * kRadPerDeg;
  const auto leave_out = [&](double from, double to) {
    for (size_t i = 0; i < sweep.yaw.size(); ++i) {
      const double distance = (sweep.yaw[i] - mean) / kRadPerDeg;
      if (distance > from && distance < to) sweep.fits[i].reset();
    }
  };
  leave_out(-90, -10);
  leave_out(20, 101);
  EXPECT_NEAR(sweep.StandardDeviation({{mean, 1.0}}), std::sqrt(9000.0 / 3.0 / 30.0) * kRadPerDeg,
              1e-3);
  leave_out(10, 20);
  EXPECT_NEAR(sweep.StandardDeviation({{mean, 1.0}}), 20.0 * kRadPerDeg / std::sqrt(12.0), 1e-3);
}

TEST(YawSweep, StandardDeviationOfAYawAloneIsThatOfItsStep) {
  for (const double others_cost : {100.0, 800.0, 1e5}) {
    YawSweep sweep = SweepOf([&](double yaw) { return yaw == 0.0 ? 0.0 : others_cost; }, 60);
    sweep.fits[1].reset();
    sweep.fits[59].reset();
    const double step = std::numbers::pi / 60.0;
    for (const double rounding : {0.0, 4e-16, -1e-12}) {
      EXPECT_NEAR(sweep.StandardDeviation({{rounding, 0.0}}), step / std::sqrt(12.0), 1e-6);
    }
  }
}

// From two steps away to a quarter turn, either way, all yaws are as likely; it is less so.
TEST(YawSweep, StandardDeviationOfAYawAloneCountsTheOthersByTheirCosts) {
  constexpr double kMore = 3.0;
  YawSweep sweep = SweepOf([&](double yaw) { return yaw == 0.0 ? kMore : 0.0; }, 60);
  sweep.fits[1].reset();
  sweep.fits[59].reset();
  const double step = std::numbers::pi / 60.0;
  const double squares =
      2.0 / 3.0 * (std::pow(0.5 * std::numbers::pi, 3) - std::pow(2.0 * step, 3));
  const double mass = 56.0 * step + std::exp(-kMore) * step;
  EXPECT_NEAR(sweep.StandardDeviation({{0.0, kMore}}), std::sqrt(squares / mass), 1e-3);
}

}  // namespace
}  // namespace soslam
