// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/tracks.h"

#include <fmt/format.h>

#include "base/error.h"

namespace soslam {

const nlohmann::json& TrackAt(const nlohmann::json& tracks, const nlohmann::json& index,
                              const std::string& file) {
  if (index.is_number() && index.get<size_t>() < tracks.size()) return tracks[index.get<size_t>()];
  throw InputError(fmt::format("{}: found track {} of {}; expected one in the list", file,
                               index.dump(), tracks.size()));
}

std::string RarelyDetectedInWords(int frames, int frames_in_sight) {
  return fmt::format("detected in only {} of the {} images that should show it", frames,
                     frames_in_sight);
}

}  // namespace soslam
