// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/dataset_json.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class ReadDistortionTest : public testing::Test {
 protected:
  std::optional<Distortion> Read(const std::string& distortion) {
    WriteBytes(folder_ / "camera.json", R"({"width": 640, "height": 480, "fx": 500, "fy": 500,
                                            "cx": 320, "cy": 240)" +
                                            distortion + "}");
    return ReadDistortion(folder_ / "camera.json");
  }
  TemporaryFolder folder_;
};

TEST_F(ReadDistortionTest, FiveCoefficientsInOpenCvsOrder) {
  const auto distortion = Read(R"(, "distortion": [0.1, -0.2, 0.003, -0.004, 0.5])");
  ASSERT_TRUE(distortion);
  EXPECT_EQ(distortion->k1, 0.1);
  EXPECT_EQ(distortion->k2, -0.2);
  EXPECT_EQ(distortion->p1, 0.003);
  EXPECT_EQ(distortion->p2, -0.004);
  EXPECT_EQ(distortion->k3, 0.5);
}

TEST_F(ReadDistortionTest, AbsentMeansNone) { EXPECT_FALSE(Read("")); }

TEST_F(ReadDistortionTest, OtherThanFiveNumbersIsRefused) {
  ExpectError<InputError>([&] { Read(R"(, "distortion": [0.1, -0.2, 0.003, -0.004])"); },
                          {"camera.json", "distortion is [0.1", "5 numbers"});
  ExpectError<InputError>([&] { Read(R"(, "distortion": null)"); },
                          {"camera.json", "distortion is null"});
}

}  // namespace
}  // namespace soslam
