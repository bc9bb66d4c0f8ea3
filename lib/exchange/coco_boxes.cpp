// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/coco_boxes.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "dataset/coco_labels.h"
#include "dataset/labelled_box.h"
#include "initialisation/semantic_table.h"

namespace soslam {
namespace {

using nlohmann::json;

// Of all labels of the worlds' objects, with a landmark or without.
std::map<std::string, int> CategoryIds(const std::vector<World>& worlds) {
  std::map<std::string, int> coco_ids;
  for (size_t i = 0; i < CocoLabels().size(); ++i) {
    coco_ids[NormalisedLabel(CocoLabels()[i])] = CocoCategoryId(static_cast<int>(i));
  }
  std::map<std::string, int> ids;
  for (const World& world : worlds) {
    for (const WorldObject& object : world.objects) ids[object.label];
  }
  int next_id = kFirstOtherCategory;
  for (auto& [label, id] : ids) {
    const auto coco_id = coco_ids.find(NormalisedLabel(label));
    id = coco_id != coco_ids.end() ? coco_id->second : next_id++;
  }
  return ids;
}

// The part of the outline's box that is in the image, from the image's outer corner.
std::optional<Box> VisibleBox(const WorldFrame& frame, const Landmark& landmark_in_world) {
  const auto outline =
      OutlineBox(frame.camera, Transform(frame.world_from_camera.Inverse(), landmark_in_world));
  if (!outline) return std::nullopt;
  const Box whole = ToCornerOrigin(*outline);
  const Box visible = {std::max(whole.x_min, 0.0), std::max(whole.y_min, 0.0),
                       std::min(whole.x_max, static_cast<double>(frame.camera.width)),
                       std::min(whole.y_max, static_cast<double>(frame.camera.height))};
  if (!(visible.Width() > 0.0) || !(visible.Height() > 0.0)) return std::nullopt;
  return visible;
}

}  // namespace

std::string CocoResultsText(const std::vector<World>& worlds) {
  const std::map<std::string, int> category_ids = CategoryIds(worlds);
  json results = json::array();
  for (const World& world : worlds) {
    for (const WorldFrame& frame : world.frames) {
      for (const WorldObject& object : world.objects) {
        if (!object.estimate.landmark_in_world) continue;
        const auto box = VisibleBox(frame, *object.estimate.landmark_in_world);
        if (!box) continue;
        results.push_back({{"image_id", frame.id},
                           {"category_id", category_ids.at(object.label)},
                           {"bbox", {box->x_min, box->y_min, box->Width(), box->Height()}},
                           {"score", object.score},
                           {"category_name", object.label},
                           {"object_id", object.id}});
      }
    }
  }
  return results.dump(1) + "\n";
}

std::string CocoDatasetText(const std::vector<World>& worlds) {
  json images = json::array();
  for (const World& world : worlds) {
    for (const WorldFrame& frame : world.frames) {
      // Readers want a name even where there is no image.
      images.push_back({{"id", frame.id},
                        {"file_name", frame.image.empty() ? std::to_string(frame.id) : frame.image},
                        {"width", frame.camera.width},
                        {"height", frame.camera.height}});
    }
  }
  // Labels of which COCO has one are one category, with the first one's name.
  std::map<int, std::string> names;
  for (const auto& [label, id] : CategoryIds(worlds)) names.emplace(id, label);
  json categories = json::array();
  for (const auto& [id, name] : names) categories.push_back({{"id", id}, {"name", name}});
  const json dataset = {
      {"images", images}, {"categories", categories}, {"annotations", json::array()}};
  return dataset.dump(1) + "\n";
}

}  // namespace soslam
