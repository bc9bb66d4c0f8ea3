// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/object_table.h"

#include <fmt/format.h>

#include <map>

#include "base/error.h"

namespace soslam {
namespace {

int PlaneIndex(const ListedObject& object, const std::vector<SupportPlane>& planes,
               const std::string& file) {
  if (planes.empty()) return kNoPlane;
  if (!object.plane_id) {
    if (planes.size() == 1) return 0;
    throw InputError(
        fmt::format("{}: object {} ('{}') has no support_plane; expected one, as there are {} "
                    "planes; or no planes.json, where they are to be estimated",
                    file, object.id, object.label, planes.size()));
  }
  for (size_t i = 0; i < planes.size(); ++i) {
    if (planes[i].id == *object.plane_id) return static_cast<int>(i);
  }
  throw InputError(
      fmt::format("{}: support_plane of object {} is {}; expected an id of planes.json", file,
                  object.id, *object.plane_id));
}

}  // namespace

std::vector<Object> ListObjects(const DatasetFiles& files, const std::vector<ListedObject>& given,
                                const std::vector<DetectionRow>& rows,
                                const std::vector<SupportPlane>& planes) {
  std::map<int, std::pair<ListedObject, std::string>> listed;  // with the file that has it
  for (const ListedObject& object : given) {
    listed[object.id] = {object, files.objects.value_or(files.detections).string()};
  }
  for (const DetectionRow& row : rows) {
    const ListedObject only_detected{row.object_id, row.label, std::nullopt, std::nullopt};
    listed.try_emplace(row.object_id, only_detected, files.detections.string());
  }
  std::vector<Object> objects;
  for (const auto& [id, object_and_file] : listed) {
    const auto& [object, file] = object_and_file;
    objects.push_back({id, object.label, PlaneIndex(object, planes, file), object.ground_truth});
  }
  return objects;
}

}  // namespace soslam
