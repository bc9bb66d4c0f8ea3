// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "soslam/base/description.h"
#include "soslam/base/options.h"
#include "soslam/training/furniture_model.h"
#include "soslam/training/furniture_view.h"

namespace soslam {

// A group of things of which a head learns which way they face.
struct TrainingGroup {
  std::string name;
  double share = 0.0;
  std::vector<std::string> labels;
  std::vector<std::string> models;
  std::map<std::string, int> parametric;
};
struct TrainingGroups {
  std::string description;
  std::vector<std::string> left_out;
  std::vector<TrainingGroup> groups;
};
template <typename Visitor>
void Describe(Visitor& visit, TrainingGroup& group) {
  visit.Field("name", &group.name, "what a head calls the group", kNotEmpty);
  visit.Field("share", &group.share, "share of the rendered views", kShare);
  visit.Field("labels", &group.labels, "labels of detections that belong to it");
  visit.Field("models", &group.models, "names of models in catalogues, whatever their case");
  visit.OrAbsent("parametric", &group.parametric, "how many models of kinds of ParametricModel");
}
template <typename Visitor>
void Describe(Visitor& visit, TrainingGroups& file) {
  visit.OrAbsent("description", &file.description, "for readers of the file");
  visit.OrAbsent("left_out", &file.left_out, "models not to train on: collection/file");
  visit.Field("groups", &file.groups, "at least one", {.least_items = 1});
}

struct TrainingCropsOptions {
  int crops = 20000;
  int views = 1;
  int seed = 1;
  std::string layers;
  int side = 224;
  bool is_rgb = false;
  std::string sheets;

  void Describe(OptionVisitor& visit) {
    visit.Group("Views");
    visit.Integer("crops", &crops, {1, 10000000}, "rendered views");
    visit.Integer("views_per_look", &views, {1, 1000},
                  "views of a model in the same colours and proportions, one after the other");
    visit.Integer("seed", &seed, {0, 2147483647}, "seed of all that is random");
    visit.Group("Network");
    visit.Text("layers", &layers, "names of the inner tensors, commas between several");
    visit.Integer("side_px", &side, {32, 1024}, "side of the network's input");
    visit.Flag("rgb_0_1", &is_rgb,
               "the network takes red, green, blue in 0 .. 1, as those of Ultralytics; otherwise "
               "blue, green, red in 0 .. 255");
    visit.Group("To look at");
    visit.Text("sheets", &sheets, "folder for pictures of 40 views of each group; empty: none");
  }
};

struct TrainingModel {
  int group;  // index
  FurnitureEntry entry;
  FurnitureModel model;
};

// The parametric models of all groups, then their models in the furniture libraries that are in a
// folder. Throws InputError, also where there is no library, or no such parametric kind.
std::vector<TrainingModel> ReadTrainingModels(const std::filesystem::path& folder,
                                              const std::vector<TrainingGroup>& groups);

// How much the model turned about its z axis by 0, 10, 20 ... 350 degrees differs from itself: mean
// difference of grey levels where either is seen, over views from all sides.
std::vector<float> DifferenceFromTurned(const FurnitureModel& model);

struct TrainingView {
  int model = 0;  // index
  FurnitureView view;
};

// A random view of one of the models, by the shares of the groups, each of which has models, among
// all of them. Views are numbered: each depends only on its number and the options. Throws
// InputError for a model that cannot be seen.
TrainingView NumberedView(const std::vector<TrainingModel>& models,
                          const std::vector<TrainingGroup>& groups,
                          const TrainingCropsOptions& options, int number);

// The crop of a view in small, with an arrow where the front points.
cv::Mat DrawSmallPicture(const FurnitureView& view);

// Whole rows of such pictures; empty without one.
cv::Mat MakeSheet(const std::vector<cv::Mat>& pictures);

}  // namespace soslam
