// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/describe_metrics.h"

#include <gtest/gtest.h>

#include "soslam/artefact/described_json.h"

namespace soslam {
namespace {

TEST(DescribeMetricsTest, WhatIsReadIsWrittenAgain) {
  Metrics metrics;
  metrics.dataset = "room";
  metrics.objects = {{3, 2, 2, 0.5, 0.25, 6.0, 7.0}};
  metrics.objects.front().label = "cup";
  EXPECT_EQ(DescribedToJson(metrics).dump().find("front"), std::string::npos);
  metrics.objects.front().front = {170.0, true};
  metrics.summary.fronts = {1, 170.0, 170.0, 0.0, 1, 1};
  metrics.map_quality.emplace();
  metrics.map_quality->landmarks.emplace_back().label = "tv";
  metrics.map_quality->objects.emplace_back().object_index = 4;
  const nlohmann::json file = DescribedToJson(metrics);
  EXPECT_EQ(file["objects"][0]["label"], "cup");
  EXPECT_EQ(DescribedToJson(DescribedFromJson<Metrics>(file)), file);
}

}  // namespace
}  // namespace soslam
