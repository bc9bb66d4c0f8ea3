// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/iou.h"
#include "soslam/geometry/wireframe.h"
#include "soslam/orientation/cuboids.h"
#include "support/random.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

CuboidOptions WithoutShape() {
  CuboidOptions options;
  options.shape_weight = 0.0;
  return options;
}

// A cuboid, alone in the image, and its exact box.
struct SeenCuboid {
  SeenCuboid()
      : floor(RandomFloor()),
        truth(RandomUprightBody(floor, kCuboidExponent)),
        view{TestCamera(), *OutlineBox(TestCamera(), truth), floor} {}

  std::vector<LineSegment> VisibleEdges() const {
    std::vector<LineSegment> visible;
    for (const LineSegment3& edge : VisibleCuboidEdges(truth)) {
      visible.push_back({*TestCamera().Project(PointAt(truth, edge[0])),
                         *TestCamera().Project(PointAt(truth, edge[1]))});
    }
    return visible;
  }
  // With the segments of most visible edges.
  CuboidEvidence Evidence() const {
    constexpr double kMinSegmentFraction = 0.1;
    return EvidenceInBox(ComputeEdgeMaps(DrawCuboids(TestCamera(), {truth}), {}), view.box,
                         kMinSegmentFraction);
  }

  Plane floor;
  Landmark truth;
  CuboidView view;
};

// Cuboids whose box is so large that edges are known to a small part of it.
SeenCuboid LargeInView() {
  for (;;) {
    SeenCuboid seen;
    const Box& box = seen.view.box;
    if (box.Width() > 120 && box.Height() > 120 && DistanceToBorder(box, 640, 480) > 10) {
      return seen;
    }
  }
}

// Whether the truth costs less than all proposals that overlap it little.
bool IsPreferred(const SeenCuboid& seen, const CuboidEvidence& evidence) {
  std::vector<CuboidErrors> errors = {
      ComputeErrors(seen.view, seen.truth, evidence, WithoutShape())};
  for (const CuboidProposal& proposal : ProposeCuboids(seen.view, 15, 10)) {
    if (BoxIou(proposal.landmark_in_camera, seen.truth) > 0.8) continue;
    errors.push_back(
        ComputeErrors(seen.view, proposal.landmark_in_camera, evidence, WithoutShape()));
  }
  const auto costs = CuboidCosts(errors, WithoutShape());
  return std::ranges::min_element(costs) == costs.begin();
}

constexpr int kTries = 20;

// The segment detector leaves out edges, and joins some that are almost in line.
TEST(CuboidCosts, MostlyPreferTheTruthInImages) {
  int preferred = 0;
  for (int i = 0; i < kTries; ++i) {
    const SeenCuboid seen = LargeInView();
    preferred += IsPreferred(seen, seen.Evidence()) ? 1 : 0;
  }
  EXPECT_GE(preferred, kTries * 3 / 4);
}

// Edges of the truth as line segments leave no difference of angles; a yaw far from it does.
TEST(CuboidErrors, HaveNoAngleForTheirOwnEdges) {
  for (int i = 0; i < 50; ++i) {
    const SeenCuboid seen;
    CuboidEvidence evidence{cv::Mat::zeros(480, 640, CV_32FC1), seen.VisibleEdges()};
    // An axis that points along the view has no visible edge.
    const double hidden_axes = evidence.segments.size() == 4 ? 1.0 : 0.0;
    EXPECT_NEAR(ComputeErrors(seen.view, seen.truth, evidence, {}).angle,
                hidden_axes * 30.0 * kRadPerDeg, 1e-6);
    EXPECT_GT(
        ComputeErrors(seen.view, RotatedAboutZ(seen.truth, 0.4), evidence, CuboidOptions()).angle,
        0.02);
  }
}

TEST(CuboidErrors, HaveTheExcessOfTheFootprintsRatioAsShape) {
  SeenCuboid seen;
  const CuboidEvidence evidence{cv::Mat::zeros(480, 640, CV_32FC1), {}};
  const auto shape = [&](double a, double b, double threshold) {
    CuboidOptions options;
    options.shape_threshold = threshold;
    seen.truth.half_axes = {a, b, 0.1};
    return ComputeErrors(seen.view, seen.truth, evidence, options).shape;
  };
  EXPECT_NEAR(shape(0.2, 0.2, 1.0), 0.0, 1e-12);
  EXPECT_NEAR(shape(0.4, 0.2, 1.0), 1.0, 1e-12);
  EXPECT_NEAR(shape(0.1, 0.3, 1.0), 2.0, 1e-12);
  EXPECT_NEAR(shape(0.1, 0.3, 2.5), 0.5, 1e-12);
  EXPECT_NEAR(shape(0.1, 0.2, 2.5), 0.0, 1e-12);
}

TEST(CuboidCosts, AreWeightedSumsOfScaledErrors) {
  CuboidOptions options;
  options.angle_weight = 0.5;
  options.shape_weight = 2.0;
  const auto costs = CuboidCosts({{0.1, 3.0, 0.0}, {0.3, 1.0, 0.0}, {0.2, 2.0, 1.5}}, options);
  EXPECT_NEAR(costs[0], 0.5, 1e-12);
  EXPECT_NEAR(costs[1], 1.0, 1e-12);
  EXPECT_NEAR(costs[2], 0.5 + 0.25 + 3.0, 1e-12);
}

// LSD on images of a few pixels, also at the image border.
TEST(EvidenceInBox, SurvivesTinyBoxes) {
  const SeenCuboid seen;
  const EdgeMaps maps = ComputeEdgeMaps(DrawCuboids(TestCamera(), {seen.truth}), {});
  for (double size = 0.0; size < 12.0; size += 0.25) {
    for (const Eigen::Vector2d& at : {Eigen::Vector2d(300, 300), {0, 0}, {639, 479}, {639.5, 20}}) {
      const Box box = {at.x(), at.y(), at.x() + size, at.y() + 0.3 * size};
      EXPECT_NO_THROW(EvidenceInBox(maps, box, 0.0)) << size << " " << at.transpose();
    }
  }
}

}  // namespace
}  // namespace soslam
