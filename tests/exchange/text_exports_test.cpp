// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "dataset/text_file.h"
#include "dataset/trajectories.h"
#include "exchange/exports.h"
#include "geometry/angles.h"
#include "support/exported_world.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

// The table of these worlds as read back: rows of fields by column.
std::vector<std::map<std::string, std::string>> TableOf(const std::vector<World>& worlds) {
  const std::string text = LandmarksCsvText(worlds);
  CsvColumns columns;
  std::istringstream header(text.substr(0, text.find('\n')));
  for (std::string name; std::getline(header, name, ',');) columns.required.push_back(name);
  const TemporaryFolder folder;
  WriteBytes(folder / "landmarks.csv", text);
  std::vector<std::map<std::string, std::string>> table;
  ForEachCsvRow(folder / "landmarks.csv", columns,
                [&](const CsvRow& row) { table.push_back(row.fields); });
  return table;
}

TEST(LandmarksCsvTest, RowsHoldWhatTheMapKnows) {
  const World world = ExportedWorld();
  const auto table = TableOf({world});
  ASSERT_EQ(table.size(), 4u);
  for (size_t i = 0; i < 3; ++i) {
    const WorldObject& object = world.objects[i];
    const Landmark& landmark = *object.estimate.landmark_in_world;
    const auto number = [&](const char* column) { return std::stod(table[i].at(column)); };
    EXPECT_EQ(table[i].at("id"), std::to_string(object.id));
    EXPECT_EQ(table[i].at("label"), object.label);
    EXPECT_EQ(table[i].at("segment"), "4");
    EXPECT_EQ(number("observations"), object.estimate.observations);
    EXPECT_EQ(number("centre_y"), landmark.Centre().y());
    EXPECT_EQ(number("qx"), landmark.frame_from_object.rotation.x());
    EXPECT_EQ(number("qw"), landmark.frame_from_object.rotation.w());
    EXPECT_EQ(number("half_axis_a"), landmark.half_axes.x());
    EXPECT_EQ(number("half_axis_c"), landmark.half_axes.z());
    EXPECT_NEAR(number("yaw_deg"), YawOf(object) * kDegPerRad, 1e-9);
    EXPECT_EQ(number("shape_exponent"), landmark.shape_exponent);
    EXPECT_EQ(table[i].at("failure"), "");
    EXPECT_EQ(table[i].at("fate"), "");
  }
}

TEST(LandmarksCsvTest, VerdictsOfAnEvaluationAreLast) {
  World world = ExportedWorld();
  world.objects[0].verdict = LandmarkVerdict{"found", 7, 0.5};
  world.objects[1].verdict = LandmarkVerdict{"false", std::nullopt, std::nullopt, "background"};
  const auto table = TableOf({world});
  EXPECT_EQ(table[0].at("fate"), "found");
  EXPECT_EQ(table[0].at("true_object"), "7");
  EXPECT_EQ(table[0].at("iou"), "0.5");
  EXPECT_EQ(table[0].at("reason"), "");
  EXPECT_EQ(table[1].at("iou"), "");
  EXPECT_EQ(table[1].at("reason"), "background");
}

TEST(LandmarksCsvTest, SigmasAreOfMetresAndDegrees) {
  World world = ExportedWorld();
  world.objects[0].support_normal = Eigen::Vector3d(0.0, 0.6, 0.8);
  world.objects[0].estimate.landmark_in_world->half_axes = {1.0, 2.0, 3.0};
  Covariance9 covariance = Covariance9::Zero();
  covariance.diagonal() << 0.0, 0.01, 0.02, 0.04, 0.09, 0.16, 0.01, 0.0225, 0.04;
  covariance(1, 2) = covariance(2, 1) = 0.005;
  world.objects[0].estimate.covariance = covariance;
  const auto row = TableOf({world})[0];
  const auto number = [&](const char* column) { return std::stod(row.at(column)); };
  EXPECT_NEAR(number("sigma_centre_x"), 0.2, 1e-12);
  EXPECT_NEAR(number("sigma_centre_z"), 0.4, 1e-12);
  EXPECT_NEAR(number("sigma_half_axis_a"), 0.1, 1e-12);
  EXPECT_NEAR(number("sigma_half_axis_b"), 0.3, 1e-12);
  EXPECT_NEAR(number("sigma_half_axis_c"), 0.6, 1e-12);
  // 0.36 * 0.01 + 0.64 * 0.02 + 2 * 0.48 * 0.005
  EXPECT_NEAR(number("sigma_yaw_deg"), std::sqrt(0.0212) * kDegPerRad, 1e-9);
}

TEST(LandmarksCsvTest, WhatIsNotThereIsEmpty) {
  const auto table = TableOf({ExportedWorld()});
  EXPECT_EQ(table[1].at("sigma_centre_x"), "");
  EXPECT_EQ(table[1].at("sigma_yaw_deg"), "");
  EXPECT_NE(table[0].at("sigma_yaw_deg"), "");
  EXPECT_EQ(table[3].at("centre_x"), "");
  EXPECT_EQ(table[3].at("shape_exponent"), "");
  EXPECT_EQ(table[3].at("failure"), "no_start");

  World world = ExportedWorld();
  world.objects[3].segment.reset();
  EXPECT_EQ(TableOf({world})[3].at("segment"), "");
}

TEST(TumTrajectoryTest, ReadsBackBitForBit) {
  World world = ExportedWorld();
  for (WorldFrame& frame : world.frames) {
    // Exactly those of a unit quaternion, for the reader divides by the norm.
    frame.world_from_camera = {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5),
                               RandomVector(-1e-7, 1e-7) + RandomVector(-100, 100)};
  }
  const TemporaryFolder folder;
  WriteBytes(folder / "poses.txt", TumTrajectoryText(world));
  const std::vector<TimedPose> poses = ReadTrajectory(folder / "poses.txt");
  ASSERT_EQ(poses.size(), world.frames.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].timestamp, world.frames[i].timestamp);
    const Rigid3d& expected = world.frames[i].world_from_camera;
    EXPECT_EQ(poses[i].world_from_camera.translation, expected.translation);
    EXPECT_EQ(poses[i].world_from_camera.rotation.coeffs(), expected.rotation.coeffs());
  }
}

}  // namespace
}  // namespace soslam
