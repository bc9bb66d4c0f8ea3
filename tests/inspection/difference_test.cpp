// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/inspection/difference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/random_estimates.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

// The first artefact is a map, unless a test writes another one.
class DifferenceTest : public testing::Test {
 protected:
  DifferenceTest() { WriteMap(One(), map_, sequence_, {}); }

  std::filesystem::path One() const { return folder_ / "one"; }
  std::filesystem::path Two() const { return folder_ / "two"; }
  Differences Compare(double tolerance = 0.0) const {
    return CompareArtefacts(One(), Two(), tolerance);
  }

  TemporaryFolder folder_;
  Sequence sequence_ = RandomSequence();
  MapEstimate map_ = RandomMap();
};

TEST_F(DifferenceTest, ArraysNameTheirLargestDifference) {
  map_.objects[0].landmark_in_world->half_axes = {1.0, 2.0, 4.0};
  WriteMap(One(), map_, sequence_, {});
  WriteMap(Two(), map_, sequence_, {});
  EXPECT_EQ(FormatDifferences(Compare(), 0.0, false), "content of kind 'map' is equal within 0\n");
  map_.objects[0].landmark_in_world->half_axes = {1.25, 2.0, 5.0};
  WriteMap(Two(), map_, sequence_, {});
  const Differences differences = Compare(0.1);
  ASSERT_EQ(differences.content.size(), 1u);
  const Difference& found = differences.content[0];
  EXPECT_EQ(found.place, "/objects/0/landmark/half_axes");
  EXPECT_EQ(found.one, "4");
  EXPECT_EQ(found.two, "5");
  EXPECT_EQ(found.absolute, 1.0);
  EXPECT_EQ(found.relative, 0.2);
  EXPECT_EQ(found.differing, 2u);
  EXPECT_EQ(found.of, 3u);
  EXPECT_TRUE(Compare(0.2).content.empty()) << "within the tolerance";
  EXPECT_THAT(
      FormatDifferences(differences, 0.1, false),
      testing::HasSubstr("/objects/0/landmark/half_axes  4    5    1         0.2       2 of "
                         "3"));
}

TEST_F(DifferenceTest, WhatOnlyOneHasIsListed) {
  map_.objects.pop_back();
  map_.objects[0].covariance.reset();
  map_.solver.converged = false;
  map_.solver.gated["behind_camera"] = 2;
  WriteMap(Two(), map_, sequence_, {});
  std::map<std::string, std::pair<std::string, std::string>> found;
  for (const Difference& difference : Compare().content) {
    found[difference.place] = {difference.one, difference.two};
  }
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found["/objects/2"].second, "");
  EXPECT_EQ(found["/objects/0/covariance"].second, "null");
  EXPECT_EQ(found["/solver/converged"].first, "true");
  EXPECT_EQ(found["/solver/gated/behind_camera"].first, "");
}

TEST_F(DifferenceTest, ProvenanceIsNamedApart) {
  WriteMap(One(), map_, sequence_, {{{"max_iterations", 10}}, {}});
  WriteMap(Two(), map_, sequence_, {{{"max_iterations", 20}}, {}});
  const Differences differences = Compare(1e9);
  EXPECT_TRUE(differences.content.empty());
  ASSERT_EQ(differences.provenance.size(), 1u);
  EXPECT_EQ(differences.provenance[0].place, "/artefact/settings/max_iterations");
  EXPECT_EQ(differences.provenance[0].two, "20");
}

TEST_F(DifferenceTest, HdfIsComparedThroughout) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  SymmetryRecord record;
  record.frame_id = 12;
  record.object_id = 3;
  record.yaw = {0.0, 1.0, 2.0, 3.0};
  record.cost["grey"] = {1.0, std::nan(""), kInfinity, 3.0};
  record.cost["lines"] = {1.0, 2.0, kInfinity, 3.0};
  record.samples = record.mirrored = {{1.0F, 2.0F}};
  record.refined_yaw = 0.5;
  WriteSymmetry(One(), {record}, {});
  record.cost["grey"][3] = 3.5;
  record.cost["lines"][2] = 3.0;
  record.cost["brief"] = {1.0, 2.0, 3.0, 4.0};
  record.samples.push_back({5.0F, 6.0F});
  record.mirrored = record.samples;
  record.refined_yaw = 0.25;
  record.yaw_sigma = 0.1;
  WriteSymmetry(Two(), {record}, {});
  const std::string group = "/observations/000012_000003/";
  std::map<std::string, Difference> found;
  for (const Difference& difference : Compare(1e-9).content) found[difference.place] = difference;
  ASSERT_EQ(found.size(), 7u);
  EXPECT_EQ(found.at(group + "cost/grey").absolute, 0.5);
  EXPECT_EQ(found.at(group + "cost/grey").differing, 1u) << "two NaN and two infinities are equal";
  EXPECT_EQ(found.at(group + "cost/lines").one, "inf");
  EXPECT_EQ(found.at(group + "cost/lines").two, "3");
  EXPECT_EQ(found.at(group + "cost/brief").one, "");
  EXPECT_EQ(found.at(group + "samples").two, "2 x 2 values");
  EXPECT_EQ(found.at(group + "mirrored").one, "1 x 2 values");
  EXPECT_EQ(found.at(group + "refined_yaw").absolute, 0.25);
  EXPECT_EQ(found.at(group + "yaw_sigma").two, "0.1");
}

TEST_F(DifferenceTest, KindsHaveToBeEqual) {
  WriteSequence(Two(), sequence_, {});
  ExpectError<InputError>([&] { Compare(); }, {One().string(), "\"map\"", "\"sequence\""});
}

}  // namespace
}  // namespace soslam
