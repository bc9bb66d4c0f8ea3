// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "artefact/hdf5_artefact.h"
#include "base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

SymmetryRecord FullRecord() {
  SymmetryRecord record;
  record.frame_id = 12;
  record.object_id = 3;
  record.yaw = {-0.1, 0.0, 0.1};
  record.cost["grey"] = {1.0, 2.0, std::nan("")};
  record.cost["improved_dt"] = {0.5, 0.25, 0.125};
  record.samples = {{1.5F, 2.0F}, {3.0F, 4.25F}};
  record.mirrored = {{10.5F, 2.0F}, {8.0F, 4.0F}};
  record.initial_yaw = -0.1;
  record.refined_yaw = 0.1;
  record.yaw_sigma = 0.02;
  record.mirror_planes = 2;
  record.true_yaw = 0.09;
  return record;
}

// The record of an observation without landmark and ground truth.
SymmetryRecord BareRecord() {
  SymmetryRecord record;
  record.frame_id = 2;
  record.object_id = 30;
  return record;
}

class SymmetryFileTest : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

TEST_F(SymmetryFileTest, RecordsComeBackInOrder) {
  WriteSymmetry(folder_ / "symmetry.h5", {FullRecord(), BareRecord()}, {});
  const auto records = ReadSymmetry(folder_ / "symmetry.h5");
  ASSERT_EQ(records.size(), 2U);

  EXPECT_EQ(records[0].frame_id, 2);
  EXPECT_EQ(records[0].object_id, 30);
  EXPECT_TRUE(records[0].yaw.empty());
  EXPECT_TRUE(records[0].cost.empty());
  EXPECT_TRUE(records[0].samples.empty());
  EXPECT_TRUE(records[0].mirrored.empty());
  EXPECT_TRUE(std::isnan(records[0].initial_yaw));
  EXPECT_TRUE(std::isnan(records[0].refined_yaw));
  EXPECT_FALSE(records[0].yaw_sigma);
  EXPECT_FALSE(records[0].mirror_planes);
  EXPECT_FALSE(records[0].true_yaw);

  const SymmetryRecord expected = FullRecord();
  EXPECT_EQ(records[1].frame_id, 12);
  EXPECT_EQ(records[1].object_id, 3);
  EXPECT_EQ(records[1].yaw, expected.yaw);
  ASSERT_EQ(records[1].cost.size(), 2U);
  EXPECT_EQ(records[1].cost.at("improved_dt"), expected.cost.at("improved_dt"));
  EXPECT_EQ(records[1].cost.at("grey")[1], 2.0);
  EXPECT_TRUE(std::isnan(records[1].cost.at("grey")[2]));
  EXPECT_EQ(records[1].samples, expected.samples);
  EXPECT_EQ(records[1].mirrored, expected.mirrored);
  EXPECT_EQ(records[1].initial_yaw, expected.initial_yaw);
  EXPECT_EQ(records[1].refined_yaw, expected.refined_yaw);
  EXPECT_EQ(records[1].yaw_sigma, expected.yaw_sigma);
  EXPECT_EQ(records[1].mirror_planes, expected.mirror_planes);
  EXPECT_EQ(records[1].true_yaw, expected.true_yaw);
}

TEST_F(SymmetryFileTest, RefusesAnImpossibleNumberOfMirrorPlanes) {
  SymmetryRecord record = FullRecord();
  record.mirror_planes = 7;
  WriteSymmetry(folder_ / "symmetry.h5", {record}, {});
  ExpectError<InputError>([&] { ReadSymmetry(folder_ / "symmetry.h5"); },
                          {"symmetry.h5", "mirror_planes", "7", "0, 1 or 2"});
}

TEST_F(SymmetryFileTest, BadFilesAreNamed) {
  EdgesWriter(folder_ / "edges.h5", {}).Commit();
  ExpectError<InputError>([&] { ReadSymmetry(folder_ / "edges.h5"); },
                          {"edges.h5", "edges", "symmetry"});
}

TEST_F(SymmetryFileTest, CurvesOfAnotherLengthAreRefused) {
  SymmetryRecord record = FullRecord();
  record.cost["grey"].pop_back();
  WriteSymmetry(folder_ / "symmetry.h5", {record}, {});
  ExpectError<InputError>([&] { ReadSymmetry(folder_ / "symmetry.h5"); },
                          {"/observations/000012_000003/cost/grey", "expected 3"});
}

}  // namespace
}  // namespace soslam
