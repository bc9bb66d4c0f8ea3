// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "artefact/json_file.h"
#include "base/error.h"
#include "geometry/box.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "geometry/rigid3.h"
#include "model/estimates.h"
#include "model/finding.h"
#include "model/sequence.h"

namespace soslam {

// Files refer to frames, planes and objects by id, code by index in a vector sorted by id. `name`
// is the name of the items in error messages.

// Throws InputError unless ids ascend.
template <typename Item>
void CheckAscendingIds(const char* name, const std::vector<Item>& items) {
  const auto pair = std::ranges::adjacent_find(items, std::greater_equal(), &Item::id);
  if (pair == items.end()) return;
  throw InputError(fmt::format("{} {} follows {} {}; expected ascending ids", name,
                               std::next(pair)->id, name, pair->id));
}

// Throws InputError when there is no such id.
template <typename Item>
int IndexOfId(const char* name, const std::vector<Item>& items, int id) {
  const auto found = std::ranges::lower_bound(items, id, {}, &Item::id);
  if (found == items.end() || found->id != id) {
    throw InputError(fmt::format("{} {} is not in the sequence", name, id));
  }
  return static_cast<int>(found - items.begin());
}

// The list of what `to_json` returns for each item, in its context.
template <typename Items, typename ToJson, typename... Context>
nlohmann::json ListToJson(const Items& items, const ToJson& to_json, const Context&... context) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& item : items) list.push_back(to_json(item, context...));
  return list;
}

// What `from_json` returns for each item of the list of this name, in its context. Empty where the
// list is absent.
template <typename FromJson, typename... Context>
auto ListFromJson(const nlohmann::json& object, const char* name, const FromJson& from_json,
                  const Context&... context) {
  std::vector<decltype(from_json(object, context...))> items;
  const auto list = object.find(name);
  if (list == object.end()) return items;
  for (const nlohmann::json& item : *list) items.push_back(from_json(item, context...));
  return items;
}

// Texts that are absent are empty in code, null in artefacts.
inline nlohmann::json NullIfEmpty(const std::string& text) {
  return text.empty() ? nlohmann::json() : nlohmann::json(text);
}

// The value of an enumeration whose values 0..n-1 have these names; the schema allows no others.
template <typename Enum, typename Names>
Enum EnumFromName(const Names& names, const std::string& name) {
  return static_cast<Enum>(std::ranges::find(names, name) - std::begin(names));
}

NLOHMANN_JSON_SERIALIZE_ENUM(Severity, {{Severity::kWarning, kSeverityNames[0]},
                                        {Severity::kError, kSeverityNames[1]}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Finding, check, severity, found, expected, cause, remedy)

// The list "findings", which is absent when empty, of any kind and version.
std::vector<Finding> FindingsFromJson(const nlohmann::json& artefact);

// Geometry in JSON, for nlohmann's `json = value` and `json.get<Value>()`. Doubles round-trip bit
// by bit. Readers assume JSON that the artefact's schema has accepted; they throw InputError,
// without the file's name, for errors that a schema cannot express.

// {"rotation_xyzw": [x, y, z, w], "translation": [x, y, z] in metres}. Reading throws InputError
// unless the quaternion has unit norm.
void to_json(nlohmann::json& json, const Rigid3d& rigid);
void from_json(const nlohmann::json& json, Rigid3d& rigid);

// {"normal": [x, y, z], "offset": metres}. Reading throws InputError unless the normal has unit
// length.
void to_json(nlohmann::json& json, const Plane& plane);
void from_json(const nlohmann::json& json, Plane& plane);

// [x_min, y_min, x_max, y_max] in pixels.
void to_json(nlohmann::json& json, const Box& box);
void from_json(const nlohmann::json& json, Box& box);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HeldOutFrame::LabelledBox, label, score, box)

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HeightPrior, point_in_world, sigma_m)

// {"width", "height", "fx", "fy", "cx", "cy"} in pixels.
void to_json(nlohmann::json& json, const Camera& camera);
void from_json(const nlohmann::json& json, Camera& camera);

// Names of the edges of a box, in the order of Box::EdgeLines.
inline constexpr std::array kEdgeNames = {"left", "top", "right", "bottom"};

// {"<frame>_from_object": rigid, "half_axes": [a, b, c] in metres, "shape_exponent": 1 to 2,
// "vertical_exponent": 1 to 2, the same if absent, "rests_on": a name of kRestingFaceNames,
// "bottom" if absent}; `frame` is "world" or "camera".
nlohmann::json LandmarkToJson(const Landmark& landmark, const std::string& frame);
Landmark LandmarkFromJson(const nlohmann::json& json, const std::string& frame);

// The exponents of such an object or of an entry of a semantic table; `absent` without any.
ShapeExponents ShapeExponentsFromJson(const nlohmann::json& json, double absent);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LabelProbability, label, probability)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PointPosterior, point, distance, responsibility)

// The field "objects" of the artefacts "landmarks" and "map": the estimates of each object from all
// its observations.
nlohmann::json ObjectEstimatesToJson(const std::vector<ObjectEstimate>& estimates,
                                     const Sequence& sequence);
// One row of "objects", read without the sequence: object_index stays 0.
ObjectEstimate ObjectEstimateFromJson(const nlohmann::json& row);
// Throws InputError for an object that the sequence does not have.
std::vector<ObjectEstimate> ObjectEstimatesFromJson(const nlohmann::json& json,
                                                    const Sequence& sequence);

}  // namespace soslam
