// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/box.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// A box of something in a frame (index in Sequence::frames). `is_whole`: no edge is cut off, as far
// as that is known.
struct SeenBox {
  int frame_index = 0;
  Box box;
  bool is_whole = true;
};

std::vector<SeenBox> BoxesOf(const Sequence& sequence, const std::vector<int>& detections);

// Something that was detected and has no landmark in the map.
struct NotPlaced {
  std::string label;
  std::vector<SeenBox> boxes;
  std::string reason;  // in words
};

// Why association left out a track, by its row in associations.json and the stage's settings.
std::string FateInWords(const nlohmann::json& track, const nlohmann::json& settings);

// Why an object has no landmark, by the failure in an artefact.
std::string FailureInWords(const std::string& failure);

// The tracks that association left out, by associations.json. `sequence` is the one that it wrote,
// or one that later stages made of it; InputError if it is not. None where the sequence is of a
// version before 1.7, which does not have their boxes.
std::vector<NotPlaced> TracksLeftOut(const nlohmann::json& associations, const Sequence& sequence);

// What a variant's folder has no landmark for, with the most boxes first: tracks that association
// left out, and objects without a landmark in the map.
std::vector<NotPlaced> ThingsNotPlaced(const std::filesystem::path& folder, const MapEstimate& map,
                                       const Sequence& sequence);

}  // namespace soslam
