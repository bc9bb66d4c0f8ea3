// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <vector>

#include "base/error.h"
#include "dataset/calibration_file.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

const std::vector<double> kFour = {0.1, -0.2, 0.003, -0.004};
const std::vector<double> kEight = {1, 2, 3, 4, 5, 6, 7, 8};

TEST(LensCameraTest, NamesOfOpenCvsModelAreKnown) {
  for (const char* model : {"pinhole", "plumb_bob", "plumb bob", "radtan", "radial-tangential",
                            "OPENCV", "Brown-Conrady", "RADIAL"}) {
    EXPECT_EQ(ParseLens(model, kFour, "a"), (Distortion{0.1, -0.2, 0.003, -0.004})) << model;
  }
  for (const char* model : {"rational_polynomial", "FULL_OPENCV", "opencv"}) {
    EXPECT_EQ(ParseLens(model, kEight, "a"), (Distortion{1, 2, 3, 4, 5, 6, 7, 8})) << model;
  }
  EXPECT_FALSE(ParseLens("pinhole", {}, "a"));
  EXPECT_FALSE(ParseLens("none", {}, "a"));
  EXPECT_EQ(ParseLens("none", std::vector<double>(5), "a"), Distortion());
}

TEST(LensCameraTest, WhatIsNoLensOfPinholeCamerasIsNamed) {
  for (const char* model : {"fisheye", "equidistant", "kannala_brandt", "OPENCV_FISHEYE", "omni",
                            "FOV", "KannalaBrandt8", "ds"}) {
    ExpectError<InputError>([&] { ParseLens(model, kFour, "camera.json"); },
                            {"camera.json", std::string("'") + model + "' is not supported",
                             "undistort", "cv::fisheye::undistortImage", "image_undistorter"});
  }
  ExpectError<InputError>([&] { ParseLens("pinehole", kFour, "a"); },
                          {"'pinehole' is not known", "plumb_bob"});
}

TEST(LensCameraTest, NumbersOfCoefficientsAreThoseOfTheModel) {
  const std::vector<double> six(6, 0.5);
  ExpectError<InputError>(
      [&] { ParseLens("pinhole", six, "camera.json"); },
      {"camera.json", "distortion has 6 numbers", "0.5 0.5", "4, 5, 8, 12, 14", "k1 k2 p1 p2 [k3"});
  ExpectError<InputError>([&] { ParseLens("plumb_bob", kEight, "a"); }, {"8 numbers", "4, 5"});
  ExpectError<InputError>([&] { ParseLens("rational_polynomial", kFour, "a"); }, {"8, 12, 14"});
  ExpectError<InputError>([&] { ParseLens("radtan", {}, "a"); }, {"has 0 numbers"});
  ExpectError<InputError>([&] { ParseLens("none", kFour, "a"); }, {"'none'", "none but 0"});
}

}  // namespace
}  // namespace soslam
