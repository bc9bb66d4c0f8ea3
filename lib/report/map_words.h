// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// What a map says of an object, in words.

// The scale of a map's world.
struct ScaleOfMap {
  bool in_metres = true;
  double log_sigma = 0.0;     // standard deviation of the logarithm of the scale; 0: exact
  std::string sentence = {};  // empty where scale and up are given
  std::string warning = {};   // what contradicts scale and up, if anything
  bool up_is_in_doubt = false;
};

// `world`: world.json, or null without it.
ScaleOfMap ScaleFromWorld(const nlohmann::json& world, const Sequence& sequence);

// Width, depth and height with their 95 % intervals: "52 × 61 × 86 cm (± 5 × 6 × 8)". The
// covariance of a map is for the scale that it has; the error of the scale is independent.
std::string SizeInWords(const ObjectEstimate& estimate, const ScaleOfMap& scale);

// "chair 62 %, or sofa 21 %": its label first, then alternatives of at least 10 %; empty where the
// label is certain. An object has a label that a box has; where another one is more probable by its
// size, this is said.
std::string LabelsInWords(const Object& object);

// Least cosine of the angle between up and the normal of a plane that is no wall.
inline constexpr double kLevel = 0.7;

// "on the floor", "on plane 2, 72 cm above the floor", ... The lowest plane is called the floor if
// one of its objects is too tall for a table and up is not in doubt.
std::string SupportInWords(const ObjectEstimate& estimate, const Sequence& sequence,
                           const MapEstimate& map, const ScaleOfMap& scale);

}  // namespace soslam
