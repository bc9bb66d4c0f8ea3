// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "soslam/dataset/class_names.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/exchange/exports.h"
#include "soslam/model/label_groups.h"

namespace soslam {
namespace {

using nlohmann::json;

// Category ids of all labels of the worlds' objects, with a landmark or without.
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

// Boxes of all landmarks, with the fields that results and annotations have in common.
std::vector<std::pair<json, const WorldObject*>> VisibleBoxes(const std::vector<World>& worlds) {
  const std::map<std::string, int> category_ids = CategoryIds(worlds);
  std::vector<std::pair<json, const WorldObject*>> boxes;
  for (const World& world : worlds) {
    for (const WorldFrame& frame : world.frames) {
      for (const WorldObject& object : world.objects) {
        if (!object.estimate.landmark_in_world) continue;
        const auto outline = OutlineBox(
            frame.camera,
            Transform(frame.world_from_camera.Inverse(), *object.estimate.landmark_in_world));
        if (!outline) continue;
        const auto visible = CutToImage(*outline, frame.camera.width, frame.camera.height);
        if (!visible) continue;
        const Box box = ToCornerOrigin(*visible);
        boxes.emplace_back(json{{"image_id", frame.id},
                                {"category_id", category_ids.at(object.label)},
                                {"bbox", {box.x_min, box.y_min, box.Width(), box.Height()}},
                                {"object_id", object.id}},
                           &object);
      }
    }
  }
  return boxes;
}

}  // namespace

std::string CocoResultsText(const std::vector<World>& worlds) {
  json results = json::array();
  for (auto& [result, object] : VisibleBoxes(worlds)) {
    result["score"] = object->score;
    result["category_name"] = object->label;
    results.push_back(result);
  }
  return results.dump(1) + "\n";
}

std::string CocoDatasetText(const std::vector<World>& worlds, CocoAnnotations annotations) {
  json images = json::array();
  for (const World& world : worlds) {
    for (const WorldFrame& frame : world.frames) {
      // Readers require a name even if there is no image.
      images.push_back({{"id", frame.id},
                        {"file_name", frame.image.empty() ? std::to_string(frame.id) : frame.image},
                        {"width", frame.camera.width},
                        {"height", frame.camera.height}});
    }
  }
  // Labels that map to the same COCO label share a category, named by the first of them.
  std::map<int, std::string> names;
  for (const auto& [label, id] : CategoryIds(worlds)) names.emplace(id, label);
  json categories = json::array();
  for (const auto& [id, name] : names) {
    categories.push_back({{"id", id}, {"name", name}, {"supercategory", "object"}});
  }
  json boxes = json::array();
  if (annotations == CocoAnnotations::kVisibleBoxes) {
    for (auto& [box, object] : VisibleBoxes(worlds)) {
      const auto bbox = box.at("bbox").get<std::array<double, 4>>();
      const double x1 = bbox[0], y1 = bbox[1], x2 = x1 + bbox[2], y2 = y1 + bbox[3];
      // pycocotools treats an id of 0 as no match, and draws the segmentation.
      box["id"] = boxes.size() + 1;
      box["area"] = bbox[2] * bbox[3];
      box["iscrowd"] = 0;
      box["segmentation"] = {{x1, y1, x1, y2, x2, y2, x2, y1}};
      boxes.push_back(box);
    }
  }
  const json dataset = {
      {"info", {{"description", "objects of soslam"}, {"version", SOSLAM_VERSION}}},
      {"licenses", json::array()},
      {"images", images},
      {"categories", categories},
      {"annotations", boxes}};
  return dataset.dump(1) + "\n";
}

}  // namespace soslam
