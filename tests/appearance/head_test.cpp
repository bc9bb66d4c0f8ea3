// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/appearance/head.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/head_file.h"

namespace soslam {
namespace {

constexpr int kChannels = 3;
constexpr int kCellCount = 49;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class HeadTest : public FolderTest {
 protected:
  Head Read(const HeadFile& file) const { return Head(file.Write(folder_ / "head.h5")); }
};

// The last layer's numbers, layer by layer from the file's numbers.
std::vector<double> OutputsOf(const HeadFile& file, const cv::Mat& features,
                              const BoxDirection& direction, int group) {
  const auto layer = [&](const std::string& name, const std::vector<double>& input, bool is_last) {
    const cv::Mat& weights = file.matrices.at("/" + name + "/weights");
    std::vector<double> outputs;
    for (int row = 0; row < weights.rows; ++row) {
      double sum = file.vectors.at("/" + name + "/bias")[row];
      for (int i = 0; i < weights.cols; ++i) sum += weights.at<float>(row, i) * input[i];
      outputs.push_back(is_last ? sum : std::max(0.0, sum));
    }
    return outputs;
  };
  std::vector<double> input;
  for (int cell = 0; cell < kCellCount; ++cell) {
    std::vector<double> channels;
    for (int c = 0; c < features.rows; ++c) channels.push_back(features.at<float>(c, cell));
    for (const double value : layer("narrow", channels, false)) input.push_back(value);
  }
  input.insert(input.end(), {direction.elevation, direction.log_aspect});
  for (int i = 0; i < 2; ++i) input.push_back(i == group ? 1.0 : 0.0);
  return layer("output", layer("hidden", input, false), true);
}

// Probabilities of the azimuths.
std::vector<double> SoftMax(const std::vector<double>& outputs) {
  std::vector<double> shares;
  for (int i = 0; i < kAzimuthBins; ++i) shares.push_back(std::exp(outputs[i]));
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= sum;
  return shares;
}

TEST_F(HeadTest, TellsWhatItsWeightsSayOfAnImageAndItsMirrorImage) {
  const HeadFile file(kChannels);
  const Head head = Read(file);
  EXPECT_EQ(head.Channels(), kChannels);
  EXPECT_EQ(head.Side(), 64);
  EXPECT_FALSE(head.IsRgb());
  EXPECT_EQ(head.NetworkSha256(), "of the network");
  EXPECT_EQ(head.Layers(), (std::vector<std::string>{"Mul 0", "last"}));
  EXPECT_EQ(head.FindGroup("stool"), 0);
  EXPECT_EQ(head.FindGroup("bed"), 1);
  EXPECT_EQ(head.FindGroup("beds"), std::nullopt);

  for (const int group : {0, 1}) {
    const cv::Mat features = 5.0 * HeadFile::RandomMatrix(kChannels, kCellCount);
    const cv::Mat mirrored = 5.0 * HeadFile::RandomMatrix(kChannels, kCellCount);
    const BoxDirection direction{Eigen::Vector3d::UnitZ(), 0.4, -0.7};
    const BoxAppearance told = head.Appearance(features, mirrored, direction, group);
    const auto outputs = OutputsOf(file, features, direction, group);
    const auto of_mirror = OutputsOf(file, mirrored, direction, group);
    const auto plain = SoftMax(outputs), mirror = SoftMax(of_mirror);
    std::vector<double> costs;
    for (int i = 0; i < kAzimuthBins; ++i) {
      const double share = 0.5 * (plain[i] + mirror[(kAzimuthBins - i) % kAzimuthBins]);
      costs.push_back(-0.5 * std::log(0.95 * share + 0.05 / kAzimuthBins));
    }
    const double lowest = *std::ranges::min_element(costs);
    for (int i = 0; i < kAzimuthBins; ++i) {
      EXPECT_NEAR(told.azimuth_costs[i], costs[i] - lowest, 1e-4) << i;
    }
    EXPECT_EQ(told.azimuth_costs.minCoeff(), 0.0F);
    EXPECT_EQ(told.direction_correlation_deg, 20.0F);
    ASSERT_EQ(told.log_ratios.has_value(), group == 0);
    if (group != 0) continue;
    // What is told times the prior of the group's models is what the weights say.
    for (int i = 0; i < 2; ++i) {
      const double prior_mean = file.matrices.at("/ratio_mean").at<float>(group, i);
      const double prior = 1.0 / 100.0;
      const double likelihood = 1.0 / std::pow(told.log_ratios->sigma[i], 2);
      const double mean =
          (prior * prior_mean + likelihood * told.log_ratios->mean[i]) / (prior + likelihood);
      EXPECT_NEAR(
          mean, prior_mean + 0.5 * (outputs[kAzimuthBins + i] + of_mirror[kAzimuthBins + i]), 1e-4);
      EXPECT_NEAR(-0.5 * std::log(prior + likelihood),
                  0.5 * (outputs[kAzimuthBins + 2 + i] + of_mirror[kAzimuthBins + 2 + i]), 1e-4);
    }
  }
}

TEST_F(HeadTest, TheMirrorImageIsSeenFromTheOppositeSide) {
  const Head head = Read(HeadFile(kChannels));
  const cv::Mat features = 5.0 * HeadFile::RandomMatrix(kChannels, kCellCount);
  const cv::Mat mirrored = 5.0 * HeadFile::RandomMatrix(kChannels, kCellCount);
  const BoxAppearance one = head.Appearance(features, mirrored, {}, 0);
  const BoxAppearance other = head.Appearance(mirrored, features, {}, 0);
  for (int i = 0; i < kAzimuthBins; ++i) {
    EXPECT_NEAR(one.azimuth_costs[i], other.azimuth_costs[(kAzimuthBins - i) % kAzimuthBins], 1e-5);
  }
}

// A head that is sure of 50 degrees, whatever it sees, is sure of 310 in the mirror.
TEST_F(HeadTest, ExponentAndFloorLimitWhatItIsSureOf) {
  HeadFile file(kChannels);
  file.matrices.at("/output/weights") = cv::Mat::zeros(kAzimuthBins + 4, 3, CV_32F);
  file.vectors.at("/output/bias").assign(kAzimuthBins + 4, 0.0F);
  file.vectors.at("/output/bias")[5] = 1000.0F;
  std::string& groups = file.texts.at("groups");
  groups.replace(groups.find("0.5"), 3, "0.7");
  file.numbers["floor"] = 0.1;
  const cv::Mat features = HeadFile::RandomMatrix(kChannels, kCellCount);
  const BoxAppearance told = Read(file).Appearance(features, features, {}, 0);
  const double least = 0.1 / kAzimuthBins;
  const double expected = 0.7 * (std::log(0.9 / 2.0 + least) - std::log(least));
  for (int i = 0; i < kAzimuthBins; ++i) {
    EXPECT_NEAR(told.azimuth_costs[i], i == 5 || i == 31 ? 0.0 : expected, 1e-4) << i;
  }
}

TEST_F(HeadTest, TellsNoRatiosWhereItIsNoSurerThanItsPrior) {
  HeadFile file(kChannels);
  file.matrices.at("/output/weights") = cv::Mat::zeros(kAzimuthBins + 4, 3, CV_32F);
  file.vectors.at("/output/bias").assign(kAzimuthBins + 4, 0.0F);
  const cv::Mat features = HeadFile::RandomMatrix(kChannels, kCellCount);
  for (const double sigma : {1.01, 0.99}) {
    file.matrices.at("/ratio_sigma").setTo(sigma);
    EXPECT_EQ(Read(file).Appearance(features, features, {}, 0).log_ratios.has_value(), sigma > 1.0);
  }
}

TEST_F(HeadTest, KnowsFeaturesOfTheProbeButForRounding) {
  const HeadFile file(kChannels);
  const Head head = Read(file);
  cv::Mat features = file.matrices.at("/probe").clone();
  features.at<float>(1, 2) += 1e-4F;
  EXPECT_TRUE(head.KnowsFeatures(features));
  for (const float other : {0.5F, static_cast<float>(kNaN)}) {
    features.at<float>(1, 2) = other;
    EXPECT_FALSE(head.KnowsFeatures(features));
  }
  EXPECT_FALSE(head.KnowsFeatures(features.rowRange(0, 2)));
}

TEST_F(HeadTest, DescriptorAndDistanceAreOfScaledMeans) {
  HeadFile file(kChannels);
  file.vectors["/feature_mean"] = {1.0F, 2.0F, 3.0F};
  file.vectors["/feature_scale"] = {0.5F, 1.0F, 2.0F};
  const Head head = Read(file);
  cv::Mat features(kChannels, kCellCount, CV_32F);
  for (int c = 0; c < kChannels; ++c) features.row(c) = cv::Scalar(4.0);
  const Eigen::Vector3f scaled(6.0F, 2.0F, 0.5F);
  EXPECT_LT((head.Descriptor(features) - scaled.normalized()).norm(), 1e-5);
  EXPECT_NEAR(head.Distance(features), std::sqrt(scaled.squaredNorm() / 3.0F), 1e-5);
}

TEST_F(HeadTest, RefusesAMalformedFileNamingFieldAndReason) {
  using Change = std::function<void(HeadFile*)>;
  const auto number = [](const char* name, double value) {
    return [=](HeadFile* file) { file->numbers[name] = value; };
  };
  const auto groups = [](const char* text) {
    return [=](HeadFile* file) { file->texts["groups"] = text; };
  };
  const std::pair<Change, std::vector<std::string>> bad[] = {
      {[](HeadFile* file) { file->kind = "edges"; }, {"edges", "head"}},
      {[](HeadFile* file) { file->texts.erase("network_sha256"); }, {"network_sha256"}},
      {[](HeadFile* file) { file->texts["layers"] = ""; }, {"layers", "expected"}},
      {number("side_px", 31), {"side_px", "31", "1024"}},
      {number("side_px", 1e300), {"side_px", "1e+300"}},
      {number("side_px", kNaN), {"side_px", "nan"}},
      {number("rgb_0_1", 2), {"rgb_0_1"}},
      {groups(R"([{"name": "a", "labels": ["x"], "exponent": -1, "ratio_sigma_scale": 1.0}])"),
       {"groups", "exponent", "-1"}},
      {number("floor", 0), {"floor"}},
      {number("floor", 1), {"floor"}},
      {number("direction_correlation_deg", -1), {"direction_correlation_deg", "-1"}},
      {number("direction_correlation_deg", kNaN), {"direction_correlation_deg", "nan"}},
      {[](HeadFile* file) { file->numbers.erase("floor"); }, {"floor"}},
      {groups("[{"), {"groups"}},
      {groups("{}"), {"groups"}},
      {groups("7"), {"groups"}},
      {groups(R"([{"name": "a", "labels": ["x"], "exponent": 1}])"),
       {"groups", "ratio_sigma_scale"}},
      {groups(R"([{"name": "a", "labels": "x", "exponent": 1, "ratio_sigma_scale": 1.0}])"),
       {"groups", "labels"}},
      {groups(R"([{"name": "a", "labels": ["x"], "exponent": 1, "ratio_sigma_scale": 1.0},
                  {"name": "b", "labels": ["x"], "exponent": 1, "ratio_sigma_scale": 1.0}])"),
       {"groups", "'x'", "a and of b"}},
      {groups(R"([{"name": "a", "labels": ["x"], "exponent": 1, "ratio_sigma_scale": 1.0}])"),
       {"/hidden/weights", "101"}},
      {[](HeadFile* file) { file->matrices.erase("/narrow/weights"); }, {"/narrow/weights"}},
      {[](HeadFile* file) { file->matrices["/narrow/weights"] = cv::Mat(0, 0, CV_32F); },
       {"/narrow/weights", "empty"}},
      {[](HeadFile* file) { file->vectors["/narrow/bias"].push_back(0.0F); }, {"/narrow/bias"}},
      {[](HeadFile* file) { file->matrices["/hidden/weights"] = HeadFile::RandomMatrix(3, 101); },
       {"/hidden/weights", "102"}},
      {[](HeadFile* file) { file->vectors["/hidden/bias"].pop_back(); }, {"/hidden/bias"}},
      {[](HeadFile* file) { file->matrices["/output/weights"] = HeadFile::RandomMatrix(39, 3); },
       {"/output/weights", "40"}},
      {[](HeadFile* file) { file->matrices["/output/weights"] = HeadFile::RandomMatrix(40, 4); },
       {"/output/weights"}},
      {[](HeadFile* file) { file->vectors["/output/bias"].pop_back(); }, {"/output/bias"}},
      {[](HeadFile* file) { file->vectors["/output/bias"][3] = kNaN; },
       {"/output/bias", "not finite"}},
      {[](HeadFile* file) { file->matrices["/narrow/weights"].at<float>(0, 0) = INFINITY; },
       {"/narrow/weights", "not finite"}},
      {[](HeadFile* file) { file->matrices["/ratio_mean"] = HeadFile::RandomMatrix(1, 2); },
       {"/ratio_mean"}},
      {[](HeadFile* file) { file->matrices["/ratio_mean"].at<float>(0, 1) = kNaN; },
       {"/ratio_mean", "row 0", "chair"}},
      {[](HeadFile* file) { file->matrices.erase("/ratio_sigma"); }, {"/ratio_sigma"}},
      {[](HeadFile* file) { file->matrices["/ratio_sigma"] = HeadFile::RandomMatrix(2, 3); },
       {"/ratio_sigma"}},
      {[](HeadFile* file) { file->matrices["/ratio_sigma"].at<float>(0, 1) = 0.0F; },
       {"/ratio_sigma", "row 0", "chair", "positive"}},
      {[](HeadFile* file) { file->matrices["/ratio_sigma"].at<float>(0, 0) = kNaN; },
       {"/ratio_sigma", "row 0", "chair"}},
      {[](HeadFile* file) { file->vectors["/feature_mean"].pop_back(); }, {"/feature_mean"}},
      {[](HeadFile* file) { file->vectors["/feature_scale"][1] = 0.0F; },
       {"/feature_scale", "has 0", "positive"}}};
  for (auto [change, words] : bad) {
    SCOPED_TRACE(testing::PrintToString(words));
    HeadFile file(kChannels);
    change(&file);
    words.push_back("head.h5");
    ExpectError<InputError>([&] { Read(file); }, words);
  }
  ExpectError<InputError>([&] { Head(folder_ / "none.h5"); }, {"none.h5"});
  HeadFile file(kChannels);
  file.matrices["/ratio_mean"].at<float>(1, 1) = kNaN;  // of a group that tells no ratios
  EXPECT_NO_THROW(Read(file));
}

}  // namespace
}  // namespace soslam
