// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "soslam/appearance/inner_layers.h"
#include "soslam/artefact/hdf5_file.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/base/progress.h"
#include "soslam/base/text.h"
#include "soslam/image/network.h"
#include "soslam/stage/stages.h"
#include "soslam/system/hash.h"
#include "soslam/training/training_crops.h"

namespace soslam {
namespace {

constexpr double kQuantum = 1.0 / 512.0;  // features are stored as multiples of it

// The features of an image and its mirror image, a row each.
cv::Mat StoredFeatures(const cv::Mat& image, const std::string& layers, InnerLayers* network) {
  const auto [features, of_mirror] = network->FeaturesOfBoth(image);
  cv::Mat both, stored;
  cv::vconcat(features.reshape(1, 1), of_mirror.reshape(1, 1), both);
  double least, most;
  cv::minMaxLoc(both, &least, &most);
  constexpr double kLimit = kQuantum * std::numeric_limits<short>::max();
  if (std::max(-least, most) > kLimit) {
    throw InputError(fmt::format(
        "layers {}: a feature is {:.4g}; expected at most {:.4g}: other layers, or ones after an "
        "activation",
        layers, std::max(-least, most), kLimit));
  }
  both.convertTo(stored, CV_16S, 1.0 / kQuantum);
  return stored;
}

void WriteModels(const std::vector<TrainingModel>& models, Hdf5File* file) {
  std::string names;
  cv::Mat turned;
  std::vector<int> groups_of_models;
  for (const TrainingModel& model : models) {
    names += fmt::format("{}\t{}\t{}\t{}\n", model.entry.collection, model.entry.name,
                         model.entry.creator, model.entry.mesh.stem().string());
    turned.push_back(cv::Mat(DifferenceFromTurned(model.model)).reshape(1, 1));
    groups_of_models.push_back(model.group);
  }
  file->WriteText("/", "models", names);
  file->WriteVector("/group_of_model", groups_of_models);
  file->WriteMatrix("/difference_from_turned", turned);
}

// Renders crops and writes their features in batches, which limit what is in memory. Adds pictures
// of views to the sheets of their groups.
void WriteCrops(const std::vector<TrainingModel>& models, const std::vector<TrainingGroup>& groups,
                const TrainingCropsOptions& options, std::vector<InnerLayers>* networks,
                std::vector<std::vector<cv::Mat>>* sheets, Hdf5File* file) {
  constexpr int kBatch = 256;
  constexpr size_t kPictures = 40;  // of a group
  Progress progress("crops", options.crops);
  std::vector<int> model_of_crop, look_of_crop;
  cv::Mat facts;  // azimuth, log ratios, elevation, log aspect, visible share
  for (int begin = 0; begin < options.crops; begin += kBatch) {
    std::vector<TrainingView> views(std::min(kBatch, options.crops - begin));
    std::vector<cv::Mat> features(views.size());
    const size_t workers = networks->size();
    ParallelFor(workers, static_cast<int>(workers), [&](size_t worker) {
      for (size_t i = worker; i < views.size(); i += workers) {
        views[i] = NumberedView(models, groups, options, begin + static_cast<int>(i));
        features[i] =
            StoredFeatures(views[i].view.crop.image, options.layers, &(*networks)[worker]);
        progress.Step();
      }
    });
    cv::Mat batch;
    cv::vconcat(features, batch);
    file->WriteMatrix(fmt::format("/features/{:06}", begin), batch);
    for (const auto& [model, view] : views) {
      const BoxDirection& direction = view.crop.direction;
      facts.push_back(
          cv::Mat((cv::Mat_<float>(1, 6) << view.azimuth, view.log_ratios.x(), view.log_ratios.y(),
                   direction.elevation, direction.log_aspect, view.visible_share)));
      look_of_crop.push_back(static_cast<int>(model_of_crop.size()) / options.views);
      model_of_crop.push_back(model);
      std::vector<cv::Mat>& sheet = (*sheets)[models[model].group];
      if (options.sheets.empty() || sheet.size() == kPictures) continue;
      sheet.push_back(DrawSmallPicture(view));
    }
  }
  file->WriteNumber("/features", "quantum", kQuantum);
  file->WriteVector("/model_of_crop", model_of_crop);
  file->WriteVector("/look_of_crop", look_of_crop);
  file->WriteMatrix("/facts", facts);
}

}  // namespace

void RunTrainingCrops(const TrainingCropsOptions& options, const StageFiles& files, int threads) {
  cv::setNumThreads(1);
  const std::vector<TrainingGroup> groups =
      ReadDocument<TrainingGroups>(ParseJsonFile(files.at("groups")), files.at("groups").string())
          .groups;
  const std::vector<TrainingModel> models = ReadTrainingModels(files.at("furniture"), groups);
  for (int i = 0; i < std::ssize(groups); ++i) {
    const auto count = std::ranges::count(models, i, &TrainingModel::group);
    fmt::print("{}: {} models\n", groups[i].name, count);
    if (count == 0) {
      throw InputError("group '" + groups[i].name + "' has no model in the catalogues");
    }
  }
  const std::string bytes = ReadNetworkFile(files.at("network")).bytes;
  const auto fields = SplitFields(options.layers);
  const std::vector<std::string> layers(fields.begin(), fields.end());
  std::vector<InnerLayers> networks;
  for (int i = 0; i < threads; ++i) {
    networks.emplace_back(bytes, files.at("network").string(), layers, options.is_rgb);
  }
  Hdf5File file = Hdf5File::Create(files.at("output"));
  file.WriteText("/", "network_sha256", Sha256OfText(bytes));
  file.WriteText("/", "layers", options.layers);
  file.WriteMatrix("/probe", networks.front().Features(ProbeImage(options.side)));
  file.WriteNumber("/", "side_px", options.side);
  file.WriteNumber("/", "rgb_0_1", options.is_rgb ? 1.0 : 0.0);
  WriteModels(models, &file);
  std::vector<std::vector<cv::Mat>> sheets(groups.size());
  WriteCrops(models, groups, options, &networks, &sheets, &file);
  file.Close();
  if (options.sheets.empty()) return;
  const std::filesystem::path folder = options.sheets;
  std::filesystem::create_directories(folder);
  for (size_t i = 0; i < sheets.size(); ++i) {
    const cv::Mat sheet = MakeSheet(sheets[i]);
    if (!sheet.empty()) cv::imwrite((folder / (groups[i].name + ".png")).string(), sheet);
  }
}

}  // namespace soslam
