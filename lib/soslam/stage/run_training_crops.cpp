// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <system_error>

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
#include "soslam/training/furniture_view.h"
#include "soslam/training/parametric_models.h"
#include "soslam/training/training_crops.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

struct NumberedModel {
  int group;
  FurnitureEntry entry;
  FurnitureModel model;
};

std::vector<NumberedModel> ReadModels(const fs::path& folder, const TrainingGroups& groups) {
  std::vector<fs::path> libraries;
  std::error_code not_listed;
  for (const auto& item : fs::directory_iterator(folder, not_listed)) {
    if (fs::exists(item.path() / "PluginFurnitureCatalog.properties")) {
      libraries.push_back(item.path());
    }
  }
  std::ranges::sort(libraries);
  if (libraries.empty()) {
    throw InputError(folder.string() + ": has no folder with PluginFurnitureCatalog.properties");
  }
  std::vector<NumberedModel> models;
  for (size_t i = 0; i < groups.groups.size(); ++i) {
    for (const auto& [kind, count] : groups.groups[i].parametric) {
      for (int k = 0; k < count; ++k) {
        Random random(static_cast<std::uint64_t>(k) + 1);
        const auto model = ParametricModel(kind, &random);
        if (!model)
          throw InputError("group '" + groups.groups[i].name + "': no such kind: " + kind);
        const FurnitureEntry entry{
            "parametric", kind, "", "soslam", fmt::format("{} {}", kind, k), {}};
        models.push_back({static_cast<int>(i), entry, *model});
      }
    }
  }
  for (const fs::path& library : libraries) {
    for (const FurnitureEntry& entry : ReadFurnitureLibrary(library)) {
      for (size_t i = 0; i < groups.groups.size(); ++i) {
        const bool is_of_group = std::ranges::any_of(
            groups.groups[i].models,
            [&](const std::string& name) { return LowerCase(name) == LowerCase(entry.name); });
        if (is_of_group) {
          models.push_back({static_cast<int>(i), entry, ReadFurnitureModel(entry)});
          break;
        }
      }
    }
  }
  return models;
}

constexpr int kTurns = 36;

// How much the model turned about its z axis by 10, 20 ... degrees differs from itself: mean
// difference of grey levels where either is seen, over views from all sides.
std::vector<float> DifferenceFromTurned(const FurnitureModel& model) {
  constexpr int kSide = 64;
  constexpr double kElevation = 0.35;
  std::vector<cv::Mat> views;
  for (int i = 0; i < kTurns; ++i) {
    cv::Mat view = PlainView(model, 2.0 * std::numbers::pi * i / kTurns, kElevation, kSide);
    cv::GaussianBlur(view, view, {}, 1.0);
    view.convertTo(view, CV_32F);
    views.push_back(view);
  }
  std::vector<float> differences;
  for (int turn = 0; turn < kTurns; ++turn) {
    double sum = 0.0;
    for (int i = 0; i < kTurns; ++i) {
      const cv::Mat &one = views[i], &other = views[(i + turn) % kTurns];
      const cv::Mat seen = (one != 128.0f) | (other != 128.0f);
      sum += cv::mean(cv::abs(one - other), seen)[0] / kTurns;
    }
    differences.push_back(static_cast<float>(sum));
  }
  return differences;
}

void CheckRange(const cv::Mat& features, double quantum, const std::string& layers) {
  double least, most;
  cv::minMaxLoc(features, &least, &most);
  const double limit = quantum * std::numeric_limits<short>::max();
  if (std::max(-least, most) <= limit) return;
  throw InputError(fmt::format(
      "layers {}: a feature is {:.4g}; expected at most {:.4g}: other layers, or ones after an "
      "activation",
      layers, std::max(-least, most), limit));
}

}  // namespace

void RunTrainingCrops(const TrainingCropsOptions& options, const StageFiles& files, int threads) {
  cv::setNumThreads(1);
  const TrainingGroups groups =
      ReadDocument<TrainingGroups>(ParseJsonFile(files.at("groups")), files.at("groups").string());
  const std::vector<NumberedModel> models = ReadModels(files.at("furniture"), groups);
  std::vector<std::vector<const NumberedModel*>> of_group(groups.groups.size());
  std::vector<const FurnitureModel*> all;
  for (const NumberedModel& model : models) {
    of_group[model.group].push_back(&model);
    all.push_back(&model.model);
  }
  for (size_t i = 0; i < of_group.size(); ++i) {
    fmt::print("{}: {} models\n", groups.groups[i].name, of_group[i].size());
    if (of_group[i].empty()) {
      throw InputError("group '" + groups.groups[i].name + "' has no model in the catalogues");
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
  std::string names;
  cv::Mat turned;
  std::vector<int> groups_of_models;
  for (const NumberedModel& model : models) {
    names += fmt::format("{}\t{}\t{}\t{}\n", model.entry.collection, model.entry.name,
                         model.entry.creator, model.entry.mesh.stem().string());
    turned.push_back(cv::Mat(DifferenceFromTurned(model.model)).reshape(1, 1));
    groups_of_models.push_back(model.group);
  }
  file.WriteText("/", "models", names);
  file.WriteVector("/group_of_model", groups_of_models);
  file.WriteMatrix("/difference_from_turned", turned);

  // Batches limit what is in memory.
  constexpr int kBatch = 256;
  constexpr double kQuantum = 1.0 / 512.0;  // features are stored as multiples of it
  constexpr int kTries = 200;
  Progress progress("crops", options.crops);
  std::vector<int> model_of_crop, look_of_crop;
  cv::Mat facts;  // azimuth, log ratios, elevation, log aspect, visible share
  std::vector<std::vector<cv::Mat>> sheets(groups.groups.size());
  for (int begin = 0; begin < options.crops; begin += kBatch) {
    const int count = std::min(kBatch, options.crops - begin);
    std::vector<FurnitureView> views(count);
    std::vector<int> chosen(count);
    std::vector<cv::Mat> features(count);
    ParallelFor(threads, threads, [&](size_t thread) {
      for (int i = static_cast<int>(thread); i < count; i += threads) {
        const auto seed = static_cast<std::uint64_t>(options.seed) * 1000003ULL;
        const auto number = static_cast<std::uint64_t>(begin + i);
        const auto views_per_look = static_cast<std::uint64_t>(options.views);
        Random look(seed + number / views_per_look);
        Random random(seed + number + (1ULL << 40));
        double place = look.Uniform(0.0, 1.0);
        size_t group = 0;
        while (group + 1 < of_group.size() && place > groups.groups[group].share) {
          place -= groups.groups[group++].share;
        }
        const NumberedModel* model = of_group[group][look.Index(of_group[group].size())];
        chosen[i] = static_cast<int>(model - models.data());
        std::optional<FurnitureView> view;
        for (int tries = 0; !view && tries < kTries; ++tries) {
          view = RandomView(model->model, all, options.side, look, &random);
        }
        if (!view) {
          throw InputError(
              fmt::format("{}: cannot be seen in any of {} views; expected a model of "
                          "triangles that have areas",
                          model->entry.mesh.string(), kTries));
        }
        views[i] = *view;
        cv::Mat mirrored;
        cv::flip(view->crop.image, mirrored, 1);
        cv::Mat both;
        for (const cv::Mat& image : {view->crop.image, mirrored}) {
          both.push_back(networks[thread].Features(image).reshape(1, 1));
        }
        CheckRange(both, kQuantum, options.layers);
        both.convertTo(features[i], CV_16S, 1.0 / kQuantum);
        progress.Step();
      }
    });
    cv::Mat batch;
    for (int i = 0; i < count; ++i) {
      batch.push_back(features[i]);
      const FurnitureView& view = views[i];
      const BoxDirection& direction = view.crop.direction;
      facts.push_back(
          cv::Mat((cv::Mat_<float>(1, 6) << view.azimuth, view.log_ratios.x(), view.log_ratios.y(),
                   direction.elevation, direction.log_aspect, view.visible_share)));
      model_of_crop.push_back(chosen[i]);
      look_of_crop.push_back((begin + i) / options.views);
      auto& sheet = sheets[models[chosen[i]].group];
      constexpr size_t kPictures = 40;
      if (!options.sheets.empty() && sheet.size() < kPictures) {
        cv::Mat picture = view.crop.image.clone();
        const cv::Point middle(picture.cols / 2, picture.rows / 2);
        const double length = 0.35 * picture.cols;
        const cv::Point front(cvRound(-length * std::sin(view.azimuth)),
                              cvRound(length * std::cos(view.azimuth) *
                                      std::sin(std::max(0.25, direction.elevation))));
        cv::arrowedLine(picture, middle, middle + front, {0, 0, 255}, 2);
        cv::resize(picture, picture, {140, 140}, 0, 0, cv::INTER_AREA);
        sheet.push_back(picture);
      }
    }
    file.WriteMatrix(fmt::format("/features/{:06}", begin), batch);
  }
  file.WriteNumber("/features", "quantum", kQuantum);
  file.WriteVector("/model_of_crop", model_of_crop);
  file.WriteVector("/look_of_crop", look_of_crop);
  file.WriteMatrix("/facts", facts);
  file.Close();
  if (options.sheets.empty()) return;
  fs::create_directories(options.sheets);
  for (size_t i = 0; i < sheets.size(); ++i) {
    std::vector<cv::Mat> rows;
    for (size_t j = 0; j + 8 <= sheets[i].size(); j += 8) {
      cv::Mat row;
      cv::hconcat(std::vector<cv::Mat>(sheets[i].begin() + j, sheets[i].begin() + j + 8), row);
      rows.push_back(row);
    }
    cv::Mat sheet;
    if (!rows.empty()) cv::vconcat(rows, sheet);
    if (!rows.empty())
      cv::imwrite((fs::path(options.sheets) / (groups.groups[i].name + ".png")).string(), sheet);
  }
}

}  // namespace soslam
