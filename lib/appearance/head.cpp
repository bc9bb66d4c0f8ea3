// SPDX-License-Identifier: BSD-3-Clause
#include "appearance/head.h"

#include <fmt/format.h>

#include <cmath>

#include "appearance/inner_layers.h"
#include "artefact/hdf5_artefact.h"
#include "artefact/json_file.h"
#include "base/error.h"
#include "base/text.h"

namespace soslam {
namespace {

constexpr int kCells = kPooledSide * kPooledSide;

using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXf ReadWeights(const Hdf5File& file, const std::string& name,
                            int columns = Hdf5File::kAny) {
  const cv::Mat matrix = file.ReadMatrix(name, CV_32F, Hdf5File::kAny, columns);
  return Eigen::Map<const RowMajor>(matrix.ptr<float>(), matrix.rows, matrix.cols);
}

Eigen::VectorXf ReadValues(const Hdf5File& file, const std::string& name, Eigen::Index size) {
  const auto values = file.ReadVector<float>(name, static_cast<int>(size));
  return Eigen::Map<const Eigen::VectorXf>(values.data(), size);
}

// [channels x cells]
Eigen::Map<const RowMajor> AsMatrix(const cv::Mat& features) {
  return {features.ptr<float>(), features.rows, features.cols};
}

}  // namespace

Head::Head(const std::filesystem::path& path) {
  const Hdf5File file = OpenArtefact(path, "head");
  network_sha256_ = file.ReadText("/", "network_sha256");
  const std::string layers = file.ReadText("/", "layers");
  for (const std::string_view layer : SplitFields(layers)) layers_.emplace_back(layer);
  side_ = static_cast<int>(file.ReadNumber("/", "side_px"));
  is_rgb_ = file.ReadNumber("/", "rgb_0_1") != 0.0;
  floor_ = static_cast<float>(file.ReadNumber("/", "floor"));
  correlation_deg_ = static_cast<float>(file.ReadNumber("/", "direction_correlation_deg"));
  if (side_ < 32 || side_ > 1024) {
    throw InputError(fmt::format("{}: side_px is {}; expected 32 to 1024", path.string(), side_));
  }
  if (!(floor_ > 0.0F && floor_ < 1.0F)) {
    throw InputError(
        fmt::format("{}: floor is {}; expected a probability in (0, 1)", path.string(), floor_));
  }
  const nlohmann::json groups =
      nlohmann::json::parse(file.ReadText("/", "groups"), nullptr, /*allow_exceptions=*/false);
  try {
    for (const nlohmann::json& group : groups) {
      const auto index = static_cast<int>(groups_.size());
      groups_.push_back({group.at("tells_ratios").get<bool>(), group.at("exponent").get<float>()});
      if (!(groups_.back().exponent >= 0.0F)) throw InputError("exponent below 0");
      if (groups_.back().exponent == 0.0F) continue;
      for (const auto& label : group.at("labels")) {
        group_of_label_[label.get<std::string>()] = index;
      }
    }
  } catch (const std::exception& error) {
    throw InputError(fmt::format(
        "{}: groups: expected a list of objects with name, labels, exponent and tells_ratios ({})",
        path.string(), error.what()));
  }
  narrow_weights_ = ReadWeights(file, "/narrow/weights");
  narrow_bias_ = ReadValues(file, "/narrow/bias", narrow_weights_.rows());
  const int groups_count = static_cast<int>(groups_.size());
  hidden_weights_ =
      ReadWeights(file, "/hidden/weights",
                  static_cast<int>(narrow_weights_.rows()) * kCells + 2 + groups_count);
  hidden_bias_ = ReadValues(file, "/hidden/bias", hidden_weights_.rows());
  output_weights_ = ReadWeights(file, "/output/weights", static_cast<int>(hidden_weights_.rows()));
  output_bias_ = ReadValues(file, "/output/bias", kAzimuthBins + 4);
  if (output_weights_.rows() != kAzimuthBins + 4) {
    throw InputError(fmt::format("{}: /output/weights: has {} rows; expected {}", path.string(),
                                 output_weights_.rows(), kAzimuthBins + 4));
  }
  ratio_mean_ = ReadWeights(file, "/ratio_mean", 2);
  if (ratio_mean_.rows() != groups_count) {
    throw InputError(path.string() + ": /ratio_mean: expected a row for each group");
  }
  feature_mean_ = ReadValues(file, "/feature_mean", Channels());
  feature_scale_ = ReadValues(file, "/feature_scale", Channels());
}

std::optional<int> Head::GroupOf(const std::string& label) const {
  const auto group = group_of_label_.find(label);
  return group == group_of_label_.end() ? std::nullopt : std::optional(group->second);
}

Head::Output Head::Evaluate(const cv::Mat& features, const BoxDirection& direction,
                            int group) const {
  // [cells x narrow], row after row
  const RowMajor narrow =
      ((AsMatrix(features).transpose() * narrow_weights_.transpose()).rowwise() +
       narrow_bias_.transpose())
          .cwiseMax(0.0F);
  Eigen::VectorXf input(hidden_weights_.cols());
  input.setZero();
  input.head(narrow.size()) = Eigen::Map<const Eigen::VectorXf>(narrow.data(), narrow.size());
  input[narrow.size()] = static_cast<float>(direction.elevation);
  input[narrow.size() + 1] = static_cast<float>(direction.log_aspect);
  input[narrow.size() + 2 + group] = 1.0F;
  const Eigen::VectorXf hidden = (hidden_weights_ * input + hidden_bias_).cwiseMax(0.0F);
  const Eigen::VectorXf output = output_weights_ * hidden + output_bias_;
  const AzimuthCosts scores = output.head<kAzimuthBins>();
  const float largest = scores.maxCoeff();
  const float log_sum = largest + std::log((scores.array() - largest).exp().sum());
  return {scores.array() - log_sum,
          {ratio_mean_.row(group).transpose() + output.segment<2>(kAzimuthBins),
           output.tail<2>().array().exp()}};
}

BoxAppearance Head::Appearance(const cv::Mat& features, const cv::Mat& mirrored,
                               const BoxDirection& direction, int group) const {
  const Output plain = Evaluate(features, direction, group);
  const Output mirror = Evaluate(mirrored, direction, group);
  BoxAppearance appearance;
  appearance.direction_correlation_deg = correlation_deg_;
  for (int i = 0; i < kAzimuthBins; ++i) {
    // A mirror image is seen from the opposite azimuth.
    const float probability =
        0.5F * (std::exp(plain.log_probabilities[i]) +
                std::exp(mirror.log_probabilities[(kAzimuthBins - i) % kAzimuthBins]));
    appearance.azimuth_costs[i] =
        -groups_[group].exponent * std::log((1.0F - floor_) * probability + floor_ / kAzimuthBins);
  }
  appearance.azimuth_costs.array() -= appearance.azimuth_costs.minCoeff();
  if (groups_[group].tells_ratios) {
    appearance.log_ratios = {
        0.5F * (plain.log_ratios.mean + mirror.log_ratios.mean),
        (plain.log_ratios.sigma.cwiseProduct(mirror.log_ratios.sigma)).cwiseSqrt()};
  }
  return appearance;
}

Eigen::VectorXf Head::ScaledMeans(const cv::Mat& features) const {
  return (AsMatrix(features).rowwise().mean() - feature_mean_).cwiseQuotient(feature_scale_);
}

Eigen::VectorXf Head::Descriptor(const cv::Mat& features) const {
  return ScaledMeans(features).stableNormalized();
}

float Head::Distance(const cv::Mat& features) const {
  const Eigen::VectorXf means = ScaledMeans(features);
  return std::sqrt(means.squaredNorm() / static_cast<float>(means.size()));
}

}  // namespace soslam
