// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/training/training_crops.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <system_error>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/text.h"

namespace soslam {
namespace fs = std::filesystem;

std::vector<TrainingModel> ReadTrainingModels(const fs::path& folder,
                                              const std::vector<TrainingGroup>& groups) {
  std::vector<fs::path> libraries;
  std::error_code not_listed;
  for (const auto& item : fs::directory_iterator(folder, not_listed)) {
    if (fs::exists(item.path() / kCatalogueFile)) libraries.push_back(item.path());
  }
  std::ranges::sort(libraries);
  if (libraries.empty()) {
    throw InputError(fmt::format("{}: has no folder with {}", folder.string(), kCatalogueFile));
  }
  std::vector<TrainingModel> models;
  for (size_t i = 0; i < groups.size(); ++i) {
    for (const auto& [kind, count] : groups[i].parametric) {
      for (int k = 0; k < count; ++k) {
        Random random(static_cast<std::uint64_t>(k) + 1);
        const auto model = ParametricModel(kind, &random);
        if (!model) throw InputError("group '" + groups[i].name + "': no such kind: " + kind);
        const FurnitureEntry entry{
            "parametric", kind, "", "soslam", fmt::format("{} {}", kind, k), {}};
        models.push_back({static_cast<int>(i), entry, *model});
      }
    }
  }
  for (const fs::path& library : libraries) {
    for (const FurnitureEntry& entry : ReadFurnitureLibrary(library)) {
      const auto group = std::ranges::find_if(groups, [&](const TrainingGroup& candidate) {
        return std::ranges::find(candidate.models, LowerCase(entry.name), LowerCase) !=
               candidate.models.end();
      });
      if (group == groups.end()) continue;
      models.push_back(
          {static_cast<int>(group - groups.begin()), entry, ReadFurnitureModel(entry)});
    }
  }
  return models;
}

std::vector<float> DifferenceFromTurned(const FurnitureModel& model) {
  constexpr int kTurns = 36;
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

TrainingView NumberedView(const std::vector<TrainingModel>& models,
                          const std::vector<TrainingGroup>& groups,
                          const TrainingCropsOptions& options, int number) {
  constexpr int kTries = 200;
  const auto seed = static_cast<std::uint64_t>(options.seed) * 1000003ULL;
  Random look(seed + static_cast<std::uint64_t>(number / options.views));
  Random random(seed + static_cast<std::uint64_t>(number) + (1ULL << 40));
  double place = look.Uniform(0.0, 1.0);
  int group = 0;
  while (group + 1 < std::ssize(groups) && place > groups[group].share) {
    place -= groups[group++].share;
  }
  std::vector<const FurnitureModel*> all;
  std::vector<int> of_group;  // indices
  for (const TrainingModel& model : models) {
    if (model.group == group) of_group.push_back(static_cast<int>(all.size()));
    all.push_back(&model.model);
  }
  const int index = of_group[look.Index(of_group.size())];
  for (int tries = 0; tries < kTries; ++tries) {
    if (auto view = RandomView(*all[index], all, options.side, look, &random)) {
      return {index, std::move(*view)};
    }
  }
  throw InputError(fmt::format(
      "{}: cannot be seen in any of {} views; expected a model of triangles that have areas",
      models[index].entry.mesh.string(), kTries));
}

namespace {

constexpr int kPictureSide = 140;  // pixels

}  // namespace

cv::Mat DrawSmallPicture(const FurnitureView& view) {
  cv::Mat picture = view.crop.image.clone();
  const cv::Point middle(picture.cols / 2, picture.rows / 2);
  const double length = 0.35 * picture.cols;
  const cv::Point front(cvRound(-length * std::sin(view.azimuth)),
                        cvRound(length * std::cos(view.azimuth) *
                                std::sin(std::max(0.25, view.crop.direction.elevation))));
  cv::arrowedLine(picture, middle, middle + front, {0, 0, 255}, 2);
  cv::resize(picture, picture, {kPictureSide, kPictureSide}, 0, 0, cv::INTER_AREA);
  return picture;
}

cv::Mat MakeSheet(const std::vector<cv::Mat>& pictures) {
  constexpr int kInRow = 8;
  const int rows = static_cast<int>(pictures.size()) / kInRow;
  cv::Mat sheet(rows * kPictureSide, kInRow * kPictureSide, CV_8UC3);
  for (int i = 0; i < rows * kInRow; ++i) {
    pictures[i].copyTo(
        sheet({i % kInRow * kPictureSide, i / kInRow * kPictureSide, kPictureSide, kPictureSide}));
  }
  return sheet;
}

}  // namespace soslam
