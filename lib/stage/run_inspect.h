// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "inspection/pictures.h"

namespace soslam {

// What soslam-inspect is asked for.
struct InspectRequest {
  std::filesystem::path file;
  std::optional<std::filesystem::path> csv;       // where the table goes; "-" is standard output
  std::optional<std::filesystem::path> image;     // where the picture goes, a .png
  std::optional<std::filesystem::path> sequence;  // the one that the artefact was made from
  std::optional<std::filesystem::path> dataset;   // folder with the images
  std::optional<int> frame_id;                    // of the picture
  std::optional<int> object_id;
  EdgeLayer layer = EdgeLayer::kAll;
};

// Writes the table and the picture that are asked for and returns what belongs on standard output:
// the table as CSV where that is asked for there; nothing where files were asked for; otherwise the
// artefact in words and its table, with escape sequences where `is_coloured`. Throws InputError for
// what is no artefact, SettingsError for a picture that cannot be made of it.
std::string RunInspect(const InspectRequest& request, bool is_coloured);

}  // namespace soslam
