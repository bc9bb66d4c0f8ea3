// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/appearance/head.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <utility>

#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/base/text.h"
#include "soslam/model/label_groups.h"
#include "soslam/system/hash.h"

namespace soslam {
namespace {

constexpr int kCells = kPooledSide * kPooledSide;

using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

[[noreturn]] void Refuse(const Hdf5File& file, const std::string& name, const std::string& words) {
  throw InputError(fmt::format("{}: {}: {}", file.path().string(), name, words));
}

double ReadNumber(const Hdf5File& file, const std::string& name, double min, double max) {
  const double number = file.ReadNumber("/", name);
  if (number >= min && number <= max) return number;
  Refuse(file, name, fmt::format("is {}; expected {} to {}", number, min, max));
}

Eigen::MatrixXf ReadWeights(const Hdf5File& file, const std::string& name,
                            Eigen::Index rows = Hdf5File::kAny,
                            Eigen::Index columns = Hdf5File::kAny) {
  const cv::Mat matrix =
      file.ReadMatrix(name, CV_32F, static_cast<int>(rows), static_cast<int>(columns));
  if (matrix.empty()) Refuse(file, name, "is empty; expected weights");
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

Head::Head(const std::filesystem::path& path) : path_(path.string()) {
  const Hdf5File file = OpenArtefact(path, "head");
  network_sha256_ = file.ReadText("/", "network_sha256");
  const std::string layers = file.ReadText("/", "layers");
  for (const std::string_view layer : SplitFields(layers)) layers_.emplace_back(layer);
  if (layers_.empty() || std::ranges::count(layers_, "") > 0) {
    Refuse(file, "layers", fmt::format("is '{}'; expected names, commas between several", layers));
  }
  side_ = static_cast<int>(ReadNumber(file, "side_px", 32, 1024));
  is_rgb_ = ReadNumber(file, "rgb_0_1", 0, 1) != 0.0;
  floor_ = static_cast<float>(ReadNumber(file, "floor", 1e-6, 1.0 - 1e-6));
  correlation_deg_ = static_cast<float>(ReadNumber(file, "direction_correlation_deg", 0, 180));
  const std::string of_groups = path_ + ": groups";
  groups_ = ReadDocument<std::vector<HeadGroup>>(
      nlohmann::json::parse(file.ReadText("/", "groups"), nullptr, /*allow_exceptions=*/false),
      of_groups);
  for (size_t i = 0; i < groups_.size(); ++i) {
    for (const std::string& label : groups_[i].labels) {
      const auto [other, is_new] =
          group_of_label_.emplace(NormalisedLabel(label), static_cast<int>(i));
      if (is_new) continue;
      throw InputError(fmt::format("{}: '{}' is a label of {} and of {}; expected one group of it",
                                   of_groups, label, groups_[other->second].name, groups_[i].name));
    }
  }
  const auto groups_count = static_cast<Eigen::Index>(groups_.size());
  narrow_weights_ = ReadWeights(file, "/narrow/weights");
  narrow_bias_ = ReadValues(file, "/narrow/bias", narrow_weights_.rows());
  probe_ = ReadWeights(file, "/probe", Channels(), kCells);
  hidden_weights_ = ReadWeights(file, "/hidden/weights", Hdf5File::kAny,
                                narrow_weights_.rows() * kCells + 2 + groups_count);
  hidden_bias_ = ReadValues(file, "/hidden/bias", hidden_weights_.rows());
  output_weights_ = ReadWeights(file, "/output/weights", kAzimuthBins + 4, hidden_weights_.rows());
  output_bias_ = ReadValues(file, "/output/bias", kAzimuthBins + 4);
  ratio_mean_ = ReadWeights(file, "/ratio_mean", groups_count, 2);
  ratio_sigma_ = ReadWeights(file, "/ratio_sigma", groups_count, 2);
  feature_mean_ = ReadValues(file, "/feature_mean", Channels());
  feature_scale_ = ReadValues(file, "/feature_scale", Channels());
  CheckNumbers(file);
}

void Head::CheckNumbers(const Hdf5File& file) const {
  const std::pair<const char*, bool> finite[] = {{"/narrow/weights", narrow_weights_.allFinite()},
                                                 {"/narrow/bias", narrow_bias_.allFinite()},
                                                 {"/hidden/weights", hidden_weights_.allFinite()},
                                                 {"/hidden/bias", hidden_bias_.allFinite()},
                                                 {"/output/weights", output_weights_.allFinite()},
                                                 {"/output/bias", output_bias_.allFinite()},
                                                 {"/feature_mean", feature_mean_.allFinite()},
                                                 {"/feature_scale", feature_scale_.allFinite()}};
  for (const auto& [name, is_finite] : finite) {
    if (!is_finite) Refuse(file, name, "has numbers that are not finite");
  }
  if (!(feature_scale_.minCoeff() > 0.0F)) {
    Refuse(file, "/feature_scale",
           fmt::format("has {}; expected positive numbers", feature_scale_.minCoeff()));
  }
  for (Eigen::Index i = 0; i < std::ssize(groups_); ++i) {
    if (groups_[i].ratio_sigma_scale == 0.0) continue;
    if (!ratio_mean_.row(i).allFinite() || !ratio_sigma_.row(i).allFinite() ||
        !(ratio_sigma_.row(i).minCoeff() > 0.0F)) {
      Refuse(file, "/ratio_mean, /ratio_sigma",
             fmt::format("row {} has numbers that are not finite, or sigmas that are not positive, "
                         "and the head tells ratios of {}",
                         i, groups_[i].name));
    }
  }
}

bool Head::KnowsFeatures(const cv::Mat& of_probe) const {
  constexpr float kRounding = 0.01F;  // of the largest feature
  return of_probe.rows == probe_.rows() && AsMatrix(of_probe).allFinite() &&
         (AsMatrix(of_probe) - probe_).cwiseAbs().maxCoeff() <=
             kRounding * probe_.cwiseAbs().maxCoeff();
}

std::optional<int> Head::FindGroup(const std::string& label) const {
  const auto group = group_of_label_.find(NormalisedLabel(label));
  const bool is_told =
      group != group_of_label_.end() &&
      (groups_[group->second].exponent > 0.0 || groups_[group->second].ratio_sigma_scale > 0.0);
  return is_told ? std::optional(group->second) : std::nullopt;
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
          {output.segment<2>(kAzimuthBins), output.tail<2>().array().exp()}};
}

BoxAppearance Head::Appearance(const cv::Mat& features, const cv::Mat& mirrored,
                               const BoxDirection& direction, int group) const {
  const Output plain = Evaluate(features, direction, group);
  const Output mirror = Evaluate(mirrored, direction, group);
  BoxAppearance appearance;
  appearance.direction_correlation_deg = correlation_deg_;
  const auto exponent = static_cast<float>(groups_[group].exponent);
  for (int i = 0; i < kAzimuthBins; ++i) {
    // A mirror image is seen from the opposite azimuth.
    const float probability =
        0.5F * (std::exp(plain.log_probabilities[i]) +
                std::exp(mirror.log_probabilities[(kAzimuthBins - i) % kAzimuthBins]));
    appearance.azimuth_costs[i] =
        -exponent * std::log((1.0F - floor_) * probability + floor_ / kAzimuthBins);
  }
  appearance.azimuth_costs.array() -= appearance.azimuth_costs.minCoeff();
  appearance.log_ratios =
      RatioLikelihood({0.5F * (plain.log_ratios.mean + mirror.log_ratios.mean),
                       (plain.log_ratios.sigma.cwiseProduct(mirror.log_ratios.sigma)).cwiseSqrt()},
                      group);
  return appearance;
}

std::optional<LogRatios> Head::RatioLikelihood(const LogRatios& relative, int group) const {
  const auto scale = static_cast<float>(groups_[group].ratio_sigma_scale);
  if (scale == 0.0F) return std::nullopt;
  const Eigen::Vector2f of_head = (scale * relative.sigma).cwiseAbs2().cwiseInverse();
  const Eigen::Vector2f of_prior = ratio_sigma_.row(group).cwiseAbs2().cwiseInverse();
  const Eigen::Vector2f information = of_head - of_prior;
  if (!(information.array() > 0.0F).all()) return std::nullopt;
  return LogRatios{ratio_mean_.row(group).transpose() +
                       of_head.cwiseProduct(relative.mean).cwiseQuotient(information),
                   information.cwiseInverse().cwiseSqrt()};
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

InnerLayers LoadLayers(const NetworkFile& network, const Head& head) {
  return {network.bytes, network.name, head.Layers(), head.IsRgb()};
}

bool IsNetworkOf(const NetworkFile& network, const Head& head) {
  if (Sha256OfText(network.bytes) == head.NetworkSha256()) return true;
  try {
    return head.KnowsFeatures(LoadLayers(network, head).Features(ProbeImage(head.Side())));
  } catch (const InputError&) {  // it has no such layers
    return false;
  }
}

AppearanceRecord MakeAppearanceRecord(const Sequence& sequence, const Detection& detection,
                                      const cv::Mat& image, const Head& head, InnerLayers* layers) {
  const Object& object = sequence.ObjectOf(detection);
  const Crop crop = RenderCrop(image, sequence.CameraOf(detection), detection.box,
                               detection.plane_in_camera.normal, head.Side());
  const auto [features, of_mirror] = layers->FeaturesOfBoth(crop.image);
  if (!cv::checkRange(features) || !cv::checkRange(of_mirror)) {
    throw InputError(
        fmt::format("{}: gives values that are not finite: a damaged file", layers->name()));
  }
  if (features.rows != head.Channels()) {
    throw InputError(fmt::format("{}: has {} channels in these layers; {} expects {}",
                                 layers->name(), features.rows, head.path(), head.Channels()));
  }
  return {sequence.FrameOf(detection).id, object.id,
          head.Appearance(features, of_mirror, crop.direction, *head.FindGroup(object.label)),
          head.Descriptor(features), head.Distance(features)};
}

}  // namespace soslam
