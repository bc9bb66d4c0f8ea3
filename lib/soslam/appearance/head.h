// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "soslam/appearance/appearance_file.h"
#include "soslam/appearance/crop.h"
#include "soslam/appearance/inner_layers.h"
#include "soslam/artefact/hdf5_file.h"
#include "soslam/base/description.h"
#include "soslam/image/network.h"
#include "soslam/model/appearance.h"
#include "soslam/model/sequence.h"

namespace soslam {

// A group of things of which a head knows which way they face.
struct HeadGroup {
  std::string name;
  std::vector<std::string> labels;
  double exponent = 0.0;
  double ratio_sigma_scale = 0.0;
};
template <typename Visitor>
void Describe(Visitor& visit, HeadGroup& group) {
  visit.Field("name", &group.name, "what people call it", kNotEmpty);
  visit.Field("labels", &group.labels, "labels of detections that belong to it");
  visit.Field("exponent", &group.exponent,
              "of likelihoods, which are less sure than they say; 0: the head tells nothing",
              Limits{0.0, 1e3});
  visit.Field("ratio_sigma_scale", &group.ratio_sigma_scale,
              "of what the head says of the spread of ratios; 0: it tells no ratios",
              Limits{0.0, 1e3});
}

// A small network on the inner layers of a detector network, trained on rendered furniture
// (docs/appearance.md). File: kind "head", layout in schemas/hdf5-layout.md.
class Head {
 public:
  // Throws InputError when the file is missing, damaged, not of kind "head" or too new.
  explicit Head(const std::filesystem::path& path);

  const std::string& path() const { return path_; }
  const std::string& NetworkSha256() const { return network_sha256_; }
  // True if the features of the ProbeImage are those of the network that the head was trained on,
  // but for rounding: files of the same weights by other programs differ in their bytes.
  bool KnowsFeatures(const cv::Mat& of_probe) const;
  const std::vector<std::string>& Layers() const { return layers_; }
  int Side() const { return side_; }      // of the network's input, pixels
  bool IsRgb() const { return is_rgb_; }  // red, green, blue in 0 .. 1
  int Channels() const { return static_cast<int>(narrow_weights_.cols()); }

  // Index of the group of things that a label belongs to; none: the head says nothing of it, as of
  // groups of which it learned neither azimuths nor ratios.
  std::optional<int> FindGroup(const std::string& label) const;

  // The evidence of the features (InnerLayers::Features) of a crop and of its mirror image.
  BoxAppearance Appearance(const cv::Mat& features, const cv::Mat& mirrored,
                           const BoxDirection& direction, int group) const;

  // Mean features, less those of the training and scaled by their spread, of unit length.
  Eigen::VectorXf Descriptor(const cv::Mat& features) const;
  // Root mean square of the same before it is of unit length: about 1 for crops as those of the
  // training, more for others.
  float Distance(const cv::Mat& features) const;

 private:
  // Throws InputError for numbers that are not finite, and for scales that are not positive.
  void CheckNumbers(const Hdf5File& file) const;

  struct Output {
    AzimuthCosts log_probabilities;
    LogRatios log_ratios;  // relative to the mean of the group's models
  };
  Output Evaluate(const cv::Mat& features, const BoxDirection& direction, int group) const;
  // The likelihood of a picture's ratios, `relative` to the mean of the group's models: the head's
  // answer, which is a posterior, over the distribution of these models, its prior. Empty if it is
  // no surer than they are, or the head does not tell ratios of the group.
  std::optional<LogRatios> RatioLikelihood(const LogRatios& relative, int group) const;
  Eigen::VectorXf ScaledMeans(const cv::Mat& features) const;

  std::string path_;
  std::string network_sha256_;
  std::vector<std::string> layers_;
  int side_ = 0;
  bool is_rgb_ = false;
  std::map<std::string, int> group_of_label_;
  std::vector<HeadGroup> groups_;
  float floor_ = 0.0F;            // probability that the head is wrong altogether
  float correlation_deg_ = 0.0F;  // see BoxAppearance
  Eigen::MatrixXf narrow_weights_, hidden_weights_, output_weights_;
  // Log ratios of the models that it was trained on, by group.
  Eigen::MatrixXf ratio_mean_, ratio_sigma_;
  Eigen::MatrixXf probe_;  // features of the ProbeImage
  Eigen::VectorXf narrow_bias_, hidden_bias_, output_bias_, feature_mean_, feature_scale_;
};

// The layers of a network that a head reads. Throws InputError where there are none.
InnerLayers LoadLayers(const NetworkFile& network, const Head& head);

// True for the network that the head was trained on, also in a file of another program.
bool IsNetworkOf(const NetworkFile& network, const Head& head);

// The record of what a head says of a detection with a label that it knows, in the image of its
// frame (see RenderCrop), by the layers of its network. Throws InputError for features that are not
// finite or of another number of channels than the head expects.
AppearanceRecord MakeAppearanceRecord(const Sequence& sequence, const Detection& detection,
                                      const cv::Mat& image, const Head& head, InnerLayers* layers);

}  // namespace soslam
