// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/estimates_of_sequence.h"

namespace soslam {

std::vector<ObjectEstimate> DetectedObjects(const Sequence& sequence,
                                            const std::vector<std::vector<int>>& detections) {
  std::vector<ObjectEstimate> objects;
  for (size_t i = 0; i < detections.size(); ++i) {
    if (detections[i].empty()) continue;
    ObjectEstimate object;
    object.object_index = static_cast<int>(i);
    object.observations = static_cast<int>(detections[i].size());
    if (!sequence.objects[i].is_static) object.failure = kMovingObject;
    objects.push_back(object);
  }
  return objects;
}

}  // namespace soslam
