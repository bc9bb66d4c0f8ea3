// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/points_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "artefact/hdf5_artefact.h"
#include "base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

std::vector<MapPoint> TwoPoints() {
  return {{{1.0, 2.0, 3.0}, 0.25, {{0, {10.0, 20.5}}, {7, {11.0, 21.0}}}},
          {{-1.0, 0.5, 1e-3}, 0.0, {{3, {-0.5, 639.0}}}}};
}

class PointsFileTest : public testing::Test {
 protected:
  // The error of the reader for two points, changed.
  void ExpectRefused(const std::function<void(std::vector<MapPoint>*)>& change,
                     const std::vector<std::string>& parts) {
    std::vector<MapPoint> points = TwoPoints();
    change(&points);
    WritePoints(folder_ / "points.h5", points, {});
    ExpectError<InputError>([&] { ReadPoints(folder_ / "points.h5"); }, parts);
  }

  // A file with two points and an observation each.
  void WriteArrays(const std::vector<int>& begins, int pixel_rows = 2) {
    Hdf5File file = Hdf5File::Create(folder_ / "points.h5");
    WriteArtefactHeader("points", {}, &file);
    file.WriteMatrix("/position", cv::Mat::zeros(2, 3, CV_64FC1));
    file.WriteVector("/reprojection_error_px", std::vector<double>{0.0, 0.0});
    file.WriteVector("/observation_begin", begins);
    file.WriteVector("/observation_frame", std::vector<int>{0, 1});
    file.WriteMatrix("/observation_pixel", cv::Mat::zeros(pixel_rows, 2, CV_64FC1));
    file.Close();
  }

  TemporaryFolder folder_;
};

TEST_F(PointsFileTest, PointsComeBack) {
  WritePoints(folder_ / "points.h5", TwoPoints(), {});
  const auto points = ReadPoints(folder_ / "points.h5");
  const auto expected = TwoPoints();
  ASSERT_EQ(points.size(), expected.size());
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].position_in_world, expected[i].position_in_world);
    EXPECT_EQ(points[i].reprojection_error_px, expected[i].reprojection_error_px);
    ASSERT_EQ(points[i].observations.size(), expected[i].observations.size());
    for (size_t k = 0; k < points[i].observations.size(); ++k) {
      EXPECT_EQ(points[i].observations[k].frame_id, expected[i].observations[k].frame_id);
      EXPECT_EQ(points[i].observations[k].pixel, expected[i].observations[k].pixel);
    }
  }
}

TEST_F(PointsFileTest, ImpossibleNumbersAreRefused) {
  ExpectRefused([](auto* points) { (*points)[1].position_in_world.y() = std::nan(""); },
                {"points.h5", "/position", "row 1", "nan", "finite"});
  ExpectRefused([](auto* points) { (*points)[0].observations[1].pixel.x() = 1.0 / 0.0; },
                {"/observation_pixel", "row 1", "inf", "finite"});
  ExpectRefused([](auto* points) { (*points)[0].reprojection_error_px = -1.0; },
                {"/reprojection_error_px", "row 0", "-1", "at least 0"});
  ExpectRefused([](auto* points) { (*points)[1].reprojection_error_px = std::nan(""); },
                {"/reprojection_error_px", "row 1", "nan"});
  ExpectRefused([](auto* points) { (*points)[1].observations[0].frame_id = -4; },
                {"/observation_frame", "row 2", "-4", "at least 0"});
}

TEST_F(PointsFileTest, ArraysThatDoNotFitAreRefused) {
  const auto read = [&] { ReadPoints(folder_ / "points.h5"); };
  WriteArrays({0, 1, 2});
  EXPECT_NO_THROW(read());
  WriteArrays({1, 1, 2});
  ExpectError<InputError>(read, {"/observation_begin", "row 0", "found 1", "expected 0"});
  WriteArrays({0, 5, 2});
  ExpectError<InputError>(read, {"/observation_begin", "row 2", "found 2", "above"});
  WriteArrays({0, 1, 1});
  ExpectError<InputError>(read, {"/observation_begin", "found 1", "number of rows"});
  WriteArrays({0, 2});
  ExpectError<InputError>(read, {"/observation_begin", "expected 3"});
  WriteArrays({0, 1, 2}, 3);
  ExpectError<InputError>(read, {"/observation_pixel", "expected 2 x 2"});
}

TEST_F(PointsFileTest, BadFilesAreNamed) {
  EdgesWriter(folder_ / "edges.h5", {}).Commit();
  ExpectError<InputError>([&] { ReadPoints(folder_ / "edges.h5"); },
                          {"edges.h5", "edges", "points"});
}

}  // namespace
}  // namespace soslam
