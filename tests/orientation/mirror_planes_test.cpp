// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "soslam/geometry/angles.h"
#include "soslam/orientation/refine_by_profile.h"

namespace soslam {
namespace {

// A curve that costs all but at these yaws (degrees), on a grid of 3 degrees.
struct Curve {
  explicit Curve(const std::vector<int>& symmetric_deg) {
    for (int i = 0; i < 60; ++i) {
      grid.push_back(3 * i * kRadPerDeg);
      cost.push_back(0.9 * options.asymmetry_cost);
    }
    for (const int yaw_deg : symmetric_deg) {
      cost[yaw_deg / 3] = 0.2 * options.asymmetry_cost;
    }
  }
  std::optional<int> Planes(double yaw_deg) const {
    return MirrorPlanes(grid, cost, yaw_deg * kRadPerDeg, options);
  }

  TextureOptions options;
  std::vector<double> grid;
  std::vector<double> cost;
};

TEST(MirrorPlanes, OneForASingleDipAtTheYaw) {
  const Curve curve({60});
  EXPECT_EQ(curve.Planes(60), 1);
  EXPECT_EQ(curve.Planes(62), 1);
  EXPECT_EQ(curve.Planes(240), 1);  // half a turn on
}

TEST(MirrorPlanes, TwoForDipsAQuarterTurnApart) {
  EXPECT_EQ(Curve({0, 90}).Planes(0), 2);
  EXPECT_EQ(Curve({177, 90}).Planes(1), 2);  // around the end of the grid
  EXPECT_EQ(Curve({60, 129}).Planes(60), 1);
}

TEST(MirrorPlanes, NoneWhereTheTextureIsNotSymmetric) {
  EXPECT_EQ(Curve({}).Planes(60), 0);
  EXPECT_EQ(Curve({60}).Planes(90), 0);
}

TEST(MirrorPlanes, UnknownWhereNothingIsSeen) {
  Curve unseen({60});
  unseen.cost.assign(60, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(unseen.Planes(60));
  unseen.cost.assign(60, unseen.options.asymmetry_cost);
  EXPECT_FALSE(unseen.Planes(60));
  // Symmetric at the yaw, and a quarter turn from it nobody knows.
  unseen.cost[20] = 0.1 * unseen.options.asymmetry_cost;
  EXPECT_FALSE(unseen.Planes(60));
}

}  // namespace
}  // namespace soslam
