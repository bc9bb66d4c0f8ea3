// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/metric_catalogue.h"

#include <gtest/gtest.h>

#include "soslam/artefact/described_json.h"
#include "soslam/base/table.h"
#include "soslam/model/describe_metrics.h"

namespace soslam {
namespace {

TEST(MetricTest, NamesAndPrintsValues) {
  EXPECT_EQ(kRotation.Key(), "rotation_deg");
  EXPECT_EQ(kRotation.Header(), "Rot deg");
  EXPECT_EQ(kIou.Key(), "iou");
  EXPECT_EQ(kIou.Header(), "IoU");
  EXPECT_EQ(kRotation.Text(7.1016), "7.10");
  EXPECT_EQ(kRotation.Text(std::optional<double>()), kNoValue);
  EXPECT_EQ(kLogSize.Text(MetricValues{0.1, std::nullopt, -0.125}), "0.10, -, -0.12");
  EXPECT_TRUE(kIou.IsBetter(0.5, 0.25));
  EXPECT_TRUE(kRotation.IsBetter(0.25, 0.5));
}

// The catalogue and the description of metrics.json have one name for an error.
TEST(MetricCatalogueTest, KeysAreThoseOfTheFile) {
  Metrics metrics;
  ObjectMetrics& object = metrics.objects.emplace_back();
  object = {3, 2, 2, 0.5, 0.25, 6.0, 7.0};
  object.front.deg = 8.0;
  int number = 0;
  for (const ObjectMetric& metric : kMeanMetrics) metrics.summary.*metric.mean = ++number;
  const nlohmann::json file = DescribedToJson(metrics);
  number = 0;
  for (const ObjectMetric& metric : kMeanMetrics) {
    EXPECT_EQ(file["summary"].at(metric.Key() + "_mean"), ++number);
  }
  for (const ObjectMetric& metric : kObjectMetrics) {
    EXPECT_EQ(file["objects"][0].at(metric.Key()), *metric.of(object).front());
  }
}

}  // namespace
}  // namespace soslam
