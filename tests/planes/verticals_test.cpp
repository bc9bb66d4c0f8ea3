// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angles.h"
#include "planes/up_prior.h"
#include "support/random.h"
#include "support/segment_views.h"

namespace soslam {
namespace {

constexpr double kSigma = 1.0 * kRadPerDeg;
constexpr double kSegmentCorrelation = 20.0 * kRadPerDeg;
constexpr double kMaxVerticalTilt = 12.0 * kRadPerDeg;

// Verticals, and twice as many edges of any direction.
std::vector<SegmentView> Room(const Eigen::Vector3d& up, int cameras, double arc) {
  std::vector<SegmentView> views;
  for (int i = 0; i < cameras; ++i) {
    std::vector<Eigen::Vector3d> directions(8, up);
    for (int k = 0; k < 16; ++k) directions.push_back(RandomRotation() * up);
    views.push_back(ViewOfEdges(CameraInRoom(arc * i / cameras), directions));
  }
  return views;
}

UpPrior HeldAttitude(const std::vector<SegmentView>& views) {
  std::vector<Rigid3d> poses;
  for (const SegmentView& view : views) poses.push_back(view.world_from_camera);
  return UpPriorFromCameras(poses, 5.0 * kRadPerDeg, 30.0 * kRadPerDeg, kSegmentCorrelation);
}

// Edges are exact, so only those of other directions and the cameras' attitude disturb: far less
// than one edge's standard deviation. Without verticals it is degrees.
TEST(WithVerticals, FindsUpAmongOtherEdges) {
  double before = 0.0;
  for (int i = 0; i < 10; ++i) {
    const auto views = Room(Eigen::Vector3d::UnitZ(), 12, 6.0);
    const UpPrior held = HeldAttitude(views);
    const auto found = WithVerticals(held, views, kSigma, kSegmentCorrelation, kMaxVerticalTilt);
    EXPECT_LT(AngleBetween(found.up_in_world, Eigen::Vector3d::UnitZ()), 0.3 * kRadPerDeg);
    before += AngleBetween(held.up_in_world, Eigen::Vector3d::UnitZ()) / 10;
  }
  EXPECT_GT(before, 0.5 * kRadPerDeg);
}

TEST(WithVerticals, LeavesTheAttitudeWhereThereIsNoEdge) {
  auto views = Room(Eigen::Vector3d::UnitZ(), 6, 3.0);
  for (SegmentView& view : views) view.segments.clear();
  const UpPrior held = HeldAttitude(views);
  const auto found = WithVerticals(held, views, kSigma, kSegmentCorrelation, kMaxVerticalTilt);
  EXPECT_LT((found.up_in_world - held.up_in_world).norm(), 1e-9);
  EXPECT_EQ(found.information, held.information);
}

// Up is what most edges say, but never far from how cameras are held.
TEST(WithVerticals, StaysNearTheAttitude) {
  const Eigen::Vector3d slanted(std::sin(0.7), 0.0, std::cos(0.7));
  const auto views = Room(slanted, 12, 6.0);
  const UpPrior held = HeldAttitude(views);
  const auto found = WithVerticals(held, views, kSigma, kSegmentCorrelation, kMaxVerticalTilt);
  EXPECT_LT(AngleBetween(found.up_in_world, held.up_in_world), 1.5 * kMaxVerticalTilt);
}

// The same edges again say nothing new.
TEST(WithVerticals, CamerasInOnePlaceCountAsOne) {
  const std::vector<SegmentView> one = {Room(Eigen::Vector3d::UnitZ(), 1, 0.0)};
  const std::vector<SegmentView> ten(10, one.front());
  const auto found = [&](const std::vector<SegmentView>& views) {
    return WithVerticals(HeldAttitude(views), views, kSigma, kSegmentCorrelation, kMaxVerticalTilt);
  };
  EXPECT_LT((found(one).up_in_world - found(ten).up_in_world).norm(), 1e-6);
  EXPECT_LT((found(one).information - found(ten).information).norm(),
            1e-6 * found(one).information.norm());
}

}  // namespace
}  // namespace soslam
