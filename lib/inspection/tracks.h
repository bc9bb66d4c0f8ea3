// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace soslam {

// A track of associations.json, by its index in the list of tracks. Throws InputError, which names
// the file, where there is no such track.
const nlohmann::json& TrackAt(const nlohmann::json& tracks, const nlohmann::json& index,
                              const std::string& file);

// "detected in only 3 of the 58 images that should show it"
std::string RarelyDetectedInWords(int frames, int frames_in_sight);

}  // namespace soslam
