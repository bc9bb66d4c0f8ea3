// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/turn_evidence.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>
#include <vector>

#include "soslam/planes/camera_orientation.h"

namespace soslam {
namespace {

constexpr std::array<double, kQuarterTurns> kSeenUpright = {6.0, 1.0, 1.5, 1.0};

Eigen::Vector3d UpAtTurn(double clockwise_rad) {
  return Eigen::AngleAxisd(-clockwise_rad, Eigen::Vector3d::UnitZ()) * -Eigen::Vector3d::UnitY();
}

TEST(TurnEvidenceTest, MostIsFoundInUprightImages) {
  const double upright = LogLikelihoodOfTurns({{kSeenUpright, UpOfQuarterTurn(0)}});
  for (const int quarters : {1, 2, 3}) {
    EXPECT_GT(upright, LogLikelihoodOfTurns({{kSeenUpright, UpOfQuarterTurn(quarters)}}) + 2.0);
  }
}

TEST(TurnEvidenceTest, TurnedImagesWithTurnedUpAreAsProbable) {
  // The image as it is shows up to the left: turned clockwise by a quarter it is upright.
  const std::array<double, kQuarterTurns> turned = {1.0, 6.0, 1.0, 1.5};
  EXPECT_NEAR(LogLikelihoodOfTurns({{kSeenUpright, UpAtTurn(0.3)}}),
              LogLikelihoodOfTurns({{turned, UpAtTurn(0.3 + 0.5 * std::numbers::pi)}}), 1e-9);
}

TEST(TurnEvidenceTest, QuarterTurnsAreThoseOfTheOrientations) {
  EXPECT_TRUE(UpOfQuarterTurn(0).isApprox(AxesOf(CameraOrientation::kLevel).up));
  EXPECT_TRUE(UpOfQuarterTurn(1).isApprox(AxesOf(CameraOrientation::kRolled90).up));
  EXPECT_TRUE(UpOfQuarterTurn(2).isApprox(AxesOf(CameraOrientation::kRolled180).up));
  EXPECT_TRUE(UpOfQuarterTurn(3).isApprox(AxesOf(CameraOrientation::kRolled270).up));
}

TEST(TurnEvidenceTest, NothingFoundTellsNothing) {
  EXPECT_DOUBLE_EQ(LogLikelihoodOfTurns({{{}, UpOfQuarterTurn(0)}}),
                   LogLikelihoodOfTurns({{{}, UpOfQuarterTurn(2)}}));
}

TEST(TurnEvidenceTest, CamerasThatLookDownPreferNoTurn) {
  const std::array<double, kQuarterTurns> even = {2.5, 2.5, 2.5, 2.5};
  const Eigen::Vector3d towards_camera = -Eigen::Vector3d::UnitZ();
  EXPECT_GT(LogLikelihoodOfTurns({{even, towards_camera}}),
            LogLikelihoodOfTurns({{even, UpOfQuarterTurn(0)}}));
}

TEST(TurnEvidenceTest, ImagesAreTurnedOnlyWhereThatIsMuchMoreProbable) {
  ImageTurns turns;
  turns.images = {{"a.png", {0.5, 0.6, 0.2, 0.3}}, {"b.png", {0.3, 0.6, 0.2, 0.3}}};
  ChooseTurn(&turns);
  EXPECT_EQ(turns.upright_turn_deg, 0);
  EXPECT_LT(turns.probability, 0.99);
  turns.images.push_back({"c.png", {2.0, 1.5, 2.0, 9.0}});
  ChooseTurn(&turns);
  EXPECT_EQ(turns.upright_turn_deg, 270);
  EXPECT_GT(turns.probability, 0.9);
}

}  // namespace
}  // namespace soslam
