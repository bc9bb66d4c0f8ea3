// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"
#include "soslam/model/world.h"

namespace soslam {

// "detected in only 3 of the 58 images that should show it"
std::string RarelyDetectedInWords(int frames, int frames_in_sight);

// How often an object was detected; both are 0 where that is unknown.
struct Sightings {
  int frames = 0;           // frames in which it was detected
  int frames_in_sight = 0;  // frames that should show it: near enough and not hidden
};

// Why an object of a map is uncertain, in words; empty where it is not. It is if most frames that
// should show it do not, if its place is so uncertain that its centre may be beside its body as
// seen from above (the 95 % interval reaches farther than the body, in a horizontal direction), or
// if its 95 % interval of a size includes twice and half of that. The error of the scale, which all
// objects share, does not count.
std::string DoubtsInWords(const ObjectEstimate& estimate, const Sightings& sightings,
                          const Eigen::Vector3d& up_in_world);

// The doubts about each of MapEstimate::objects, by map.json's folder, where associations.json is
// if ids were estimated. Throws InputError.
std::vector<std::string> DoubtsOfMap(const std::filesystem::path& folder, const MapEstimate& map,
                                     const Sequence& sequence);

// Why a map of photos should not be trusted, in words: up or scale are wrong as probably as not, or
// most of them have no place in it. Empty where nothing says so. `world`: null where up and scale
// are given.
std::string DistrustOfMap(const WorldReport* world, const Sequence& sequence);

}  // namespace soslam
