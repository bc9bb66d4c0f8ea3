// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/text_exports.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "dataset/trajectories.h"
#include "geometry/angles.h"
#include "support/exported_world.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

// A table by RFC 4180, with \n as line ends: rows of fields by column.
std::vector<std::map<std::string, std::string>> ParseCsv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    std::string& field = rows.back().back();
    if (text[i] == '"' && quoted && text[i + 1] == '"') {
      field += text[i++];
    } else if (text[i] == '"') {
      quoted = !quoted;
    } else if (text[i] == ',' && !quoted) {
      rows.back().emplace_back();
    } else if (text[i] == '\n' && !quoted) {
      rows.push_back({""});
    } else {
      field += text[i];
    }
  }
  EXPECT_EQ(rows.back(), std::vector<std::string>{""});  // the text ends with a line end
  rows.pop_back();
  std::vector<std::map<std::string, std::string>> table;
  for (size_t i = 1; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].size(), rows[0].size());
    auto& row = table.emplace_back();
    for (size_t column = 0; column < rows[0].size(); ++column) {
      row[rows[0][column]] = rows[i].at(column);
    }
  }
  return table;
}

TEST(LandmarksCsvTest, RowsHoldWhatTheMapKnows) {
  const World world = ExportedWorld();
  const auto table = ParseCsv(LandmarksCsvText({world}));
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
  const auto table = ParseCsv(LandmarksCsvText({world}));
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
  const auto row = ParseCsv(LandmarksCsvText({world}))[0];
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
  const auto table = ParseCsv(LandmarksCsvText({ExportedWorld()}));
  EXPECT_EQ(table[1].at("sigma_centre_x"), "");
  EXPECT_EQ(table[1].at("sigma_yaw_deg"), "");
  EXPECT_NE(table[0].at("sigma_yaw_deg"), "");
  EXPECT_EQ(table[3].at("centre_x"), "");
  EXPECT_EQ(table[3].at("shape_exponent"), "");
  EXPECT_EQ(table[3].at("failure"), "no_start");

  World world = ExportedWorld();
  world.objects[3].segment.reset();
  EXPECT_EQ(ParseCsv(LandmarksCsvText({world}))[3].at("segment"), "");
}

TEST(LandmarksCsvTest, OnlyFieldsThatNeedItAreQuoted) {
  World world;
  world.objects = {ExportedWorld().objects[3]};
  for (const auto& [label, field] :
       std::map<std::string, std::string>{{"dining table", "dining table"},
                                          {"a,b", "\"a,b\""},
                                          {"12\"", "\"12\"\"\""},
                                          {"two\nlines", "\"two\nlines\""}}) {
    world.objects[0].label = label;
    const std::string text = LandmarksCsvText({world});
    EXPECT_NE(text.find("\n8," + field + ",4,"), std::string::npos) << text;
    EXPECT_EQ(ParseCsv(text)[0].at("label"), label);
  }
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
