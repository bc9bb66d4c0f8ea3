// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/iou.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace soslam {
namespace {

Landmark RandomBox() { return {RandomRigid(0.4), RandomVector(0.2, 1.0)}; }

TEST(BoxIou, OfABoxWithItselfIsOne) {
  for (int i = 0; i < 100; ++i) {
    const Landmark box = RandomBox();
    EXPECT_NEAR(BoxIou(box, box), 1.0, 1e-9);
    // Any of the 24 ways to name the axes of the same box.
    Landmark renamed = box;
    renamed.frame_from_object.rotation =
        box.frame_from_object.rotation *
        Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
    renamed.half_axes = {box.half_axes.y(), box.half_axes.x(), box.half_axes.z()};
    EXPECT_NEAR(BoxIou(box, renamed), 1.0, 1e-9);
  }
}

// A square turned by 45 degrees in the same square overlaps in a regular octagon: 8 (sqrt(2) - 1).
TEST(BoxIou, OfACubeTurnedByAnEighthIsAnOctagonalPrism) {
  const Landmark cube{Rigid3d(), {1, 1, 1}};
  const Landmark turned = RotatedAboutZ(cube, std::numbers::pi / 4);
  EXPECT_NEAR(IntersectionVolume(cube, turned), 2.0 * 8.0 * (std::sqrt(2.0) - 1.0), 1e-12);
}

TEST(BoxIou, OfApartOrTouchingBoxesIsZero) {
  const Landmark cube{Rigid3d(), {1, 1, 1}};
  EXPECT_EQ(BoxIou(cube, {{Eigen::Quaterniond::Identity(), {5, 0, 0}}, {1, 1, 1}}), 0.0);
  EXPECT_NEAR(BoxIou(cube, {{Eigen::Quaterniond::Identity(), {2, 0, 0}}, {1, 1, 1}}), 0.0, 1e-12);
}

TEST(BoxIou, OfABoxInsideIsTheRatioOfVolumes) {
  for (int i = 0; i < 100; ++i) {
    const Landmark small{RandomRigid(0.1), RandomVector(0.05, 0.1)};
    const Landmark large{{RandomRotation(), Eigen::Vector3d::Zero()}, {1, 1, 1}};
    EXPECT_NEAR(BoxIou(small, large), small.half_axes.prod(), 1e-12);
  }
}

TEST(BoxIou, IsSymmetricAndDoesNotChangeWithTheWorldOrScale) {
  for (int i = 0; i < 200; ++i) {
    const Landmark one = RandomBox();
    const Landmark other = RandomBox();
    const double iou = BoxIou(one, other);
    EXPECT_NEAR(BoxIou(other, one), iou, 1e-9);
    const Rigid3d motion = RandomRigid();
    EXPECT_NEAR(BoxIou(Transform(motion, one), Transform(motion, other)), iou, 1e-9);
    const auto scaled = [](Landmark box) {
      box.frame_from_object.translation *= 100.0;
      box.half_axes *= 100.0;
      return box;
    };
    EXPECT_NEAR(BoxIou(scaled(one), scaled(other)), iou, 1e-9);
  }
}

}  // namespace
}  // namespace soslam
